# The CMake package `tassilo`: find_package(tassilo COMPONENTS core files ...), targets tassilo::<part>.
#
# Component core is all parts that need nothing but Eigen, target tassilo::core; every part above it is a component of its
# own name, because it brings its own third-party libraries.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tassilo)
get_property(targets GLOBAL PROPERTY TASSILO_TARGETS)

set(TASSILO_COMPONENTS core)
set(TASSILO_CORE_TARGETS)
set(TASSILO_REQUIREMENTS)   # lines of the package file: which components a component stands on
foreach(target IN LISTS targets)
  string(REPLACE tassilo_ "" part ${target})
  if(part STREQUAL app)
    continue()   # the program's own pieces are no library
  endif()
  set(component core)
  if(part IN_LIST TASSILO_APP_PARTS)
    set(component ${part})
    list(APPEND TASSILO_COMPONENTS ${part})
    set(below core)
    get_target_property(linked ${target} INTERFACE_LINK_LIBRARIES)
    foreach(other IN LISTS TASSILO_APP_PARTS)
      if(tassilo_${other} IN_LIST linked)
        string(APPEND below " ${other}")
      endif()
    endforeach()
    string(APPEND TASSILO_REQUIREMENTS "set(tassilo_${part}_REQUIRES ${below})\n")
  else()
    list(APPEND TASSILO_CORE_TARGETS tassilo::${part})
  endif()
  install(TARGETS ${target} EXPORT tassilo_${component} COMPONENT ${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY src/tassilo/${part} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tassilo COMPONENT ${component}
    FILES_MATCHING PATTERN "*.h" PATTERN internal EXCLUDE PATTERN "test_*" EXCLUDE)
endforeach()
list(REMOVE_DUPLICATES TASSILO_COMPONENTS)
foreach(component IN LISTS TASSILO_COMPONENTS)
  install(EXPORT tassilo_${component} NAMESPACE tassilo:: FILE tassilo-${component}-targets.cmake
    DESTINATION ${package_dir} COMPONENT ${component})
endforeach()

configure_package_config_file(cmake/tassilo-config.cmake.in ${PROJECT_BINARY_DIR}/tassilo-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tassilo-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tassilo-config.cmake ${PROJECT_BINARY_DIR}/tassilo-config-version.cmake
  DESTINATION ${package_dir} COMPONENT core)
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/tassilo COMPONENT core)
foreach(folder config schema ros2)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${folder})
    install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_DATADIR}/tassilo COMPONENT core)
  endif()
endforeach()
if(TARGET tassilo)
  install(TARGETS tassilo RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
