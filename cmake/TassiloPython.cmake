# The Python package is built where pybind11 and Python's headers are; else one test stands for its tests and is skipped.
#
# The interpreter is the system's, to which apt's pybind11-dev, python3-dev and python3-numpy belong, and not another one
# that comes first in the PATH; -DPython_EXECUTABLE=... takes another.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python QUIET COMPONENTS Interpreter Development.Module)
if(Python_FOUND)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
set(python_reason)
if(NOT TASSILO_PYTHON)
  set(python_reason "TASSILO_PYTHON is off")
elseif(NOT Python_FOUND OR NOT pybind11_FOUND)
  set(python_reason "pybind11 or Python's headers are not installed; tools/install_deps.sh installs them")
endif()

if(NOT python_reason)
  add_subdirectory(python)
  execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy, pytest" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed)
    set(python_reason "numpy and pytest are not installed; tools/install_deps.sh installs them")
  elseif(TASSILO_TESTS)
    foreach(test region region_features contour image color vision limits package)
      add_test(NAME python.${test} COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${PROJECT_BINARY_DIR}/python
        PYTHONDONTWRITEBYTECODE=1 TASSILO_PROGRAM=$<TARGET_FILE:tassilo> TASSILO_PLUGIN=$<TARGET_FILE:test_plugin>
        ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider python/tests/test_${test}.py
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    endforeach()
  endif()
endif()
if(python_reason AND TASSILO_TESTS)
  add_test(NAME python.all COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${python_reason}")
  set_tests_properties(python.all PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped:")
endif()
