# `cmake --install`: the command, the libraries with their headers, and a package file for find_package(bodyloom).
include(CMakePackageConfigHelpers)
set(bodyloom_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bodyloom)

get_property(bodyloom_modules GLOBAL PROPERTY BODYLOOM_MODULES)
foreach(module IN LISTS bodyloom_modules)
  install(TARGETS bodyloom_${module} EXPORT bodyloomTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/bodyloom
          FILES_MATCHING PATTERN "*.h")
endforeach()
foreach(command bodyloom_command bodyloom_neural_command)
  if(TARGET ${command})
    install(TARGETS ${command} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

set(BODYLOOM_HAS_NEURAL OFF)
if(TARGET bodyloom_neural)
  set(BODYLOOM_HAS_NEURAL ON)
endif()
install(EXPORT bodyloomTargets NAMESPACE bodyloom:: DESTINATION ${bodyloom_config_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/bodyloomConfig.cmake.in
  ${PROJECT_BINARY_DIR}/bodyloomConfig.cmake INSTALL_DESTINATION ${bodyloom_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bodyloomConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bodyloomConfig.cmake ${PROJECT_BINARY_DIR}/bodyloomConfigVersion.cmake
  DESTINATION ${bodyloom_config_dir})
