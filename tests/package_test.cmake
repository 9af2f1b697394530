# cmake -P: the example builds and runs against an installed copy.
#   MODE=installed  install the build that runs this test, everything in it
#   MODE=core_only  configure, build and install the core alone, with every optional dependency hidden
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
file(REMOVE_RECURSE ${prefix} ${WORK}/example)
set(toolchain -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

if(MODE STREQUAL core_only)
  set(hidden)
  foreach(package PkgConfig yaml-cpp PNG JPEG nlohmann_json CLI11 fmt spdlog OpenCV benchmark GTest)
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

file(GLOB_RECURSE internal ${prefix}/include/*/internal/* ${prefix}/include/*_test* ${prefix}/include/test_*)
if(internal)
  message(FATAL_ERROR "installed, but not for users: ${internal}")
endif()

run("configure example" ${CMAKE_COMMAND} -S ${SOURCE}/examples/segment_an_image -B ${WORK}/example ${toolchain}
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${prefix})
run("build example" ${CMAKE_COMMAND} --build ${WORK}/example)
run("run example" ${WORK}/example/segment_an_image)
if(NOT output MATCHES "red: area 316 px")
  message("${output}")
  message(FATAL_ERROR "the example does not say what it must, see above")
endif()
message(STATUS "${output}")
