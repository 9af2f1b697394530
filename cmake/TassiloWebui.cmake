# The pages of `tassilo serve`, from webui/ into <build>/webui, where npm is; else each of their tests is skipped.
include(GNUInstallDirs)
find_program(NPM_EXECUTABLE npm)
find_program(NODE_EXECUTABLE node)
set(webui_default OFF)
if(NPM_EXECUTABLE AND NODE_EXECUTABLE AND PROJECT_IS_TOP_LEVEL)
  set(webui_default ON)
endif()
option(TASSILO_WEBUI "build the web UI's pages; needs node and npm, and the network once" ${webui_default})

set(webui_reason)
if(NOT NPM_EXECUTABLE OR NOT NODE_EXECUTABLE)
  set(webui_reason "node and npm are not installed; tools/install_deps.sh installs them")
elseif(NOT TASSILO_WEBUI)
  set(webui_reason "TASSILO_WEBUI is off")
endif()

set(TASSILO_WEBUI_DIR ${PROJECT_BINARY_DIR}/webui)   # index.html, monitor.html and what they need
set(webui_source ${PROJECT_SOURCE_DIR}/webui)
if(NOT webui_reason)
  file(GLOB_RECURSE webui_files CONFIGURE_DEPENDS ${webui_source}/src/* ${webui_source}/public/*)
  foreach(file index.html monitor.html package.json package-lock.json tsconfig.json vite.config.ts)
    list(APPEND webui_files ${webui_source}/${file})
  endforeach()
  add_custom_command(OUTPUT ${TASSILO_WEBUI_DIR}/index.html
    COMMAND ${PROJECT_SOURCE_DIR}/tools/webui_packages.sh
    COMMAND ${NPM_EXECUTABLE} run --silent build -- --outDir ${TASSILO_WEBUI_DIR} --emptyOutDir --logLevel warn
    WORKING_DIRECTORY ${webui_source} DEPENDS ${webui_files} ${PROJECT_SOURCE_DIR}/tools/webui_packages.sh
    COMMENT "Building the web UI's pages" VERBATIM)
  add_custom_target(webui ALL DEPENDS ${TASSILO_WEBUI_DIR}/index.html)
  # Optional: whoever builds the program alone can still install it.
  install(DIRECTORY ${TASSILO_WEBUI_DIR} DESTINATION ${CMAKE_INSTALL_DATADIR}/tassilo COMPONENT program OPTIONAL)
endif()

if(TASSILO_TESTS)
  foreach(test unit browser colors calibration monitor)
    if(webui_reason)
      add_test(NAME webui.${test} COMMAND ${CMAKE_COMMAND} -E echo "skipped: ${webui_reason}")
      set_tests_properties(webui.${test} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped:")
    endif()
  endforeach()
  if(NOT webui_reason)
    add_test(NAME webui.unit COMMAND ${NPM_EXECUTABLE} run --silent test WORKING_DIRECTORY ${webui_source})
    add_test(NAME webui.browser COMMAND ${NODE_EXECUTABLE} e2e/browser.mjs --screenshots ${PROJECT_BINARY_DIR}/webui_screenshots --
      ${NODE_EXECUTABLE} mock/server.mjs --port 0 --pages ${TASSILO_WEBUI_DIR} WORKING_DIRECTORY ${webui_source})
    add_test(NAME webui.colors COMMAND ${NODE_EXECUTABLE} e2e/colors.mjs --screenshots ${PROJECT_BINARY_DIR}/webui_screenshots --
      ${NODE_EXECUTABLE} mock/server.mjs --port 0 --pages ${TASSILO_WEBUI_DIR} WORKING_DIRECTORY ${webui_source})
    add_test(NAME webui.calibration COMMAND ${NODE_EXECUTABLE} e2e/calibration.mjs --screenshots ${PROJECT_BINARY_DIR}/webui_screenshots --
      ${NODE_EXECUTABLE} mock/server.mjs --port 0 --pages ${TASSILO_WEBUI_DIR} WORKING_DIRECTORY ${webui_source})
    add_test(NAME webui.monitor COMMAND ${NODE_EXECUTABLE} e2e/monitor.mjs --screenshots ${PROJECT_BINARY_DIR}/webui_screenshots --
      ${NODE_EXECUTABLE} mock/monitor.mjs --port 0 --pages ${TASSILO_WEBUI_DIR} WORKING_DIRECTORY ${webui_source})
    # A browser is several processes; beside other tests a machine of two cores shows it all too slowly.
    set_tests_properties(webui.browser webui.colors webui.calibration webui.monitor PROPERTIES SKIP_RETURN_CODE 77 PROCESSORS 2 TIMEOUT 240)
  endif()
endif()
