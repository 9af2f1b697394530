# tassilo_part(region SOURCES runs.cpp morphology.cpp DEPS image [LINK lib ...] [TESTS runs_test.cpp ...])
#
# One part of the library, src/tassilo/<name>: a static library tassilo_<name>, alias tassilo::<name>, and one test program.
# DEPS are parts on lower floors; LINK are third-party libraries, private to the part's .cpp files.
# A part without SOURCES is header-only.
function(tassilo_part name)
  cmake_parse_arguments(PART "" "" "SOURCES;DEPS;LINK;TESTS" ${ARGN})
  set(target tassilo_${name})
  set(scope PUBLIC)
  if(PART_SOURCES)
    add_library(${target} STATIC ${PART_SOURCES})
    tassilo_warnings(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(tassilo::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  foreach(dep IN LISTS PART_DEPS)
    target_link_libraries(${target} ${scope} tassilo_${dep})
  endforeach()
  target_link_libraries(${target} ${scope} Eigen3::Eigen)
  if(PART_LINK)
    target_link_libraries(${target} PRIVATE ${PART_LINK})
  endif()
  set_property(GLOBAL APPEND PROPERTY TASSILO_TARGETS ${target})

  if(TASSILO_TESTS AND PART_TESTS)
    add_executable(${name}_tests ${PART_TESTS})
    tassilo_warnings(${name}_tests)
    target_link_libraries(${name}_tests PRIVATE ${target} GTest::gtest_main GTest::gmock ${PART_LINK})
    target_compile_definitions(${name}_tests PRIVATE TASSILO_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    gtest_discover_tests(${name}_tests TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES)
  endif()
endfunction()

# tassilo_opencv_tests(camera MODULES calib3d TESTS camera_opencv_test.cpp)
#
# Tests of a part that compare with OpenCV, added to its test program. Without OpenCV one test stands for them and is
# skipped, so that the list of skipped tests tells what was not checked.
function(tassilo_opencv_tests name)
  cmake_parse_arguments(CV "" "" "MODULES;TESTS" ${ARGN})
  if(NOT TASSILO_TESTS)
    return()
  endif()
  find_package(OpenCV QUIET COMPONENTS ${CV_MODULES})
  if(OpenCV_FOUND)
    target_sources(${name}_tests PRIVATE ${CV_TESTS})
    target_link_libraries(${name}_tests PRIVATE ${OpenCV_LIBS})
  else()
    list(JOIN CV_MODULES ", " modules)
    add_test(NAME ${name}.opencv COMMAND ${CMAKE_COMMAND} -E echo
      "skipped: OpenCV (${modules}) is not installed; tools/install_deps.sh --references installs it")
    set_tests_properties(${name}.opencv PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped:")
  endif()
endfunction()

function(tassilo_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wpedantic $<$<BOOL:${TASSILO_WERROR}>:-Werror>)
endfunction()
