# cmake -P: the example, and a user of all components, build and run against an installed copy.
#   MODE=installed  install the build that runs this test, everything in it
#   MODE=core_only  configure, build and install the core alone, with every optional dependency hidden
# PYTHON, PYTHON_DIR: the interpreter the build made a package for, and where below the prefix that is; empty: none.
# TEST_PLUGINS: the folder of the plug-ins for tests.
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
file(REMOVE_RECURSE ${prefix} ${WORK}/segment_an_image ${WORK}/package_user ${WORK}/plugin)
set(toolchain -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

if(MODE STREQUAL core_only)
  set(hidden)
  foreach(package PkgConfig Ceres apriltag yaml-cpp PNG JPEG ZLIB nlohmann_json CLI11 fmt spdlog OpenCV CycloneDDS benchmark GTest)
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

# expect(what expected): the output of the last run matches expected.
function(expect what expected)
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${what} does not say what it must: ${expected}\n${output}")
  endif()
endfunction()

# The example of a plug-in, built against the installed copy, in the installed program: listed, seen with, and refused
# where it was built for another version.
function(try_plugins)
  set(program ${prefix}/bin/tassilo)
  set(data ${SOURCE}/data/msl98)
  set(clip ${data}/d01_approach)
  run("configure the plug-in" ${CMAKE_COMMAND} -S ${SOURCE}/examples/plugin -B ${WORK}/plugin ${toolchain}
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${prefix})
  run("build the plug-in" ${CMAKE_COMMAND} --build ${WORK}/plugin)
  run("list its stages" ${program} info --stages --plugin ${WORK}/plugin/largest_blob.so)
  expect("info --stages" "\n  \\* sphere [^\n]+\n    largest_blob [^\n]+\n        largest_blob_min_area +20  px\\^2 +1 .. 100000 whole ")

  run("train colors" ${program} train colors ${data}/train_div/samples.yaml --output ${WORK}/plugin/colors.yaml)
  set(robot "colors: colors.yaml\nfield: msl98\nplugins: [largest_blob.so]\n")
  string(APPEND robot "vision: {balls: largest_blob, largest_blob_min_area: 15}\n")
  file(WRITE ${WORK}/plugin/image_robot.yaml "${robot}")
  file(WRITE ${WORK}/plugin/robot.yaml "${robot}camera: ${clip}/camera.yaml\n")
  run("list what a robot takes" ${program} info --stages --robot ${WORK}/plugin/robot.yaml)
  expect("info --stages" "\n    sphere [^\n]+\n  \\* largest_blob [^\n]+\n        largest_blob_min_area [^\n]+; here 15\n")
  # With calibration most balls lie where they are; without, they are in the image alone.
  foreach(robot robot image_robot)
    run("see with the plug-in" ${program} run --robot ${WORK}/plugin/${robot}.yaml --source ${clip}/video.mkv
      --output ${WORK}/plugin/${robot}.jsonl)
    expect("run" "\nball +40 +40\n")
  endforeach()
  run("evaluate" ${program} eval ${clip}/gt.jsonl ${WORK}/plugin/robot.jsonl)
  expect("eval" "ball +recall +(8[5-9]|9[0-9]|100)[.]")
  file(STRINGS ${WORK}/plugin/image_robot.jsonl output LIMIT_COUNT 1)
  expect("a scene without calibration" "\"balls\":.{\"x\":null,.*\"box\":.[0-9]")

  run("look where a plug-in has its memory" ${program} info --stages --plugin ${TEST_PLUGINS}/test_plugin.so)
  expect("info --stages" "blind +sees nothing, in memory of the program")
  set(other ${TEST_PLUGINS}/test_plugin_of_another_version.so)
  execute_process(COMMAND ${program} run --robot ${WORK}/plugin/robot.yaml --plugin ${other} --source ${clip}/video.mkv
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 1)
    message(FATAL_ERROR "a plug-in for another version ends with ${status}, must be refused with 1: ${output}")
  endif()
  expect("the refusal" "tassilo: ${other}: was built for 'tassilo 0.0.1 by gcc 4', this is 'tassilo [0-9.]+ by [a-z]+ [0-9]+'; build it anew\n")
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
  if(EXISTS ${BUILD}/webui/index.html AND NOT EXISTS ${prefix}/share/tassilo/webui/index.html)
    message(FATAL_ERROR "the web UI's pages are built, but not installed")
  endif()
  if(EXISTS ${prefix}/bin/tassilo)
    run("run the installed program" ${prefix}/bin/tassilo info)
    string(REGEX MATCHALL "${prefix}/share/tassilo/config" mentions "${output}")
    list(LENGTH mentions count)
    if(NOT count EQUAL 1)
      message(FATAL_ERROR "the installed program lists its folder of shipped files ${count} times, must be once: ${output}")
    endif()
    try_plugins()
  endif()
endif()
