# cmake -P: the example, and a user of all components, build and run against an installed copy.
#   MODE=installed  install the build that runs this test, everything in it
#   MODE=core_only  configure, build and install the core alone, with every optional dependency hidden
# PYTHON, PYTHON_DIR: the interpreter the build made a package for, and where below the prefix that is; empty: none.
# SOURCE, BUILD: of the project; WORK: a folder of this test; GENERATOR, COMPILER, LAUNCHER, FLAGS: as the project was built.
cmake_minimum_required(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message("${output}")
    message(FATAL_ERROR "${what} failed (${status}), see above")
  endif()
  message(STATUS "${what}: done")
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK}/segment_an_image ${WORK}/package_user)
set(toolchain -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

if(MODE STREQUAL core_only)
  set(hidden)
  foreach(package PkgConfig Ceres yaml-cpp PNG JPEG nlohmann_json CLI11 fmt spdlog OpenCV benchmark GTest)
    list(APPEND hidden -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  run("configure core" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build ${toolchain} -DCMAKE_BUILD_TYPE=Release
    -DTASSILO_APP=OFF -DTASSILO_TESTS=OFF ${hidden})
  run("build core" ${CMAKE_COMMAND} --build ${WORK}/build)
  run("install core" ${CMAKE_COMMAND} --install ${WORK}/build --prefix ${prefix})
  set(FLAGS "")
else()
  run("install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
endif()

file(GLOB_RECURSE internal ${prefix}/include/*)
list(FILTER internal INCLUDE REGEX "/internal/|_test|/test_")
if(internal)
  message(FATAL_ERROR "installed, but not for users: ${internal}")
endif()

# build_and_run(folder program expected): against the installed copy; the program's output matches expected.
function(build_and_run folder program expected)
  run("configure ${program}" ${CMAKE_COMMAND} -S ${SOURCE}/${folder} -B ${WORK}/${program} ${toolchain}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${prefix})
  run("build ${program}" ${CMAKE_COMMAND} --build ${WORK}/${program})
  run("run ${program}" ${WORK}/${program}/${program})
  message("${output}")
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${program} does not say what it must: ${expected}")
  endif()
endfunction()

build_and_run(examples/segment_an_image segment_an_image "red: area 316 px")
if(MODE STREQUAL installed)
  build_and_run(tests/package package_user "msl98 is 8.22 m long\n.*no such file.mkv")
  if(PYTHON)
    # Shipped files are found beside the installed module, not only in the source tree.
    file(COPY_FILE ${SOURCE}/config/fields/msl98.yaml ${prefix}/share/tassilo/config/fields/moved.yaml)
    run("import the installed Python package" ${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/${PYTHON_DIR} ${PYTHON} -c
      "import tassilo as t\nprint(t.__file__, t.opening(t.Region.from_box((0, 0, 9, 9)), t.disc(3.5)), t.Field.load('moved'))")
    if(NOT output MATCHES "^${prefix}/.*Region: 69 px.*Field: moved")
      message(FATAL_ERROR "the installed Python package does not say what it must: ${output}")
    endif()
  endif()
  if(EXISTS ${prefix}/bin/tassilo)
    run("run the installed program" ${prefix}/bin/tassilo info)
    string(REGEX MATCHALL "${prefix}/share/tassilo/config" mentions "${output}")
    list(LENGTH mentions count)
    if(NOT count EQUAL 1)
      message(FATAL_ERROR "the installed program lists its folder of shipped files ${count} times, must be once: ${output}")
    endif()
  endif()
endif()
