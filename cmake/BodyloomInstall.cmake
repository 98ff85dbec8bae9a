# `cmake --install`: the command, the libraries with their public headers, and a package file for find_package(bodyloom).
#   component     what
#   command       bin/bodyloom, share/bodyloom/blender, and share/bodyloom/models where ./dev models fetched them
#   neural        bin/bodyloom-neural
#   cgal          bin/bodyloom-cgal (GPL as a whole: apps/cgal/copyright)
#   python        lib/python3/dist-packages/bodyloom (python/CMakeLists.txt)
#   development   the libraries, include/bodyloom, lib/cmake/bodyloom
include(CMakePackageConfigHelpers)
set(bodyloom_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/bodyloom)

# One file of targets a library, so that a user needs no package that his components do not; and for the package file
# what each of them needs, bottom first.
get_property(bodyloom_modules GLOBAL PROPERTY BODYLOOM_MODULES)
set(BODYLOOM_COMPONENTS ${bodyloom_modules})
set(BODYLOOM_COMPONENT_NEEDS "")
foreach(module IN LISTS bodyloom_modules)
  install(TARGETS bodyloom_${module} EXPORT bodyloom_${module}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT bodyloom_${module} NAMESPACE bodyloom:: DESTINATION ${bodyloom_config_dir} COMPONENT development)
  get_property(needs GLOBAL PROPERTY BODYLOOM_NEEDS_${module})
  get_property(finds GLOBAL PROPERTY BODYLOOM_FINDS_${module})
  list(TRANSFORM finds REPLACE "^.+$" "\"\\0\"")
  list(JOIN finds " " finds)
  list(JOIN needs " " needs)
  string(APPEND BODYLOOM_COMPONENT_NEEDS "set(bodyloom_needs_${module} ${needs})\nset(bodyloom_finds_${module} ${finds})\n")
endforeach()
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/bodyloomConfig.cmake.in
  ${PROJECT_BINARY_DIR}/bodyloomConfig.cmake INSTALL_DESTINATION ${bodyloom_config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/bodyloomConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/bodyloomConfig.cmake ${PROJECT_BINARY_DIR}/bodyloomConfigVersion.cmake
        ${CMAKE_CURRENT_LIST_DIR}/FindMATIO.cmake ${CMAKE_CURRENT_LIST_DIR}/FindLibav.cmake
        ${CMAKE_CURRENT_LIST_DIR}/FindOneDNN.cmake ${CMAKE_CURRENT_LIST_DIR}/FindLiblo.cmake
        ${CMAKE_CURRENT_LIST_DIR}/FindHttplib.cmake
        DESTINATION ${bodyloom_config_dir} COMPONENT development)

# Which headers are public is looked up when they are installed: it follows from what they include then.
set(without "")
if(NOT TARGET bodyloom_neural)
  set(without neural/ pipelines/neural/)
endif()
install(CODE "
  set(source \"${PROJECT_SOURCE_DIR}\")
  set(destination \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/bodyloom\")
  set(without ${without})
  include(\"${CMAKE_CURRENT_LIST_DIR}/InstallPublicHeaders.cmake\")" COMPONENT development)

foreach(component command neural cgal)
  set(target bodyloom_command)
  set(folder bodyloom)
  set(copyright ${PROJECT_SOURCE_DIR}/LICENSE)
  if(NOT component STREQUAL command)
    set(target bodyloom_${component}_command)
    set(folder bodyloom-${component})
  endif()
  if(component STREQUAL cgal)
    set(copyright ${PROJECT_SOURCE_DIR}/apps/cgal/copyright)
  endif()
  if(TARGET ${target})
    install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
    install(FILES ${copyright} RENAME copyright
            DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${folder} COMPONENT ${component})
  endif()
endforeach()

# The detector's networks, where the command looks for them (tracking/detection/model_files.h), with their list.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/models.txt models REGEX "^file ")
list(TRANSFORM models REPLACE "^file +([^ ]+) .*" "${PROJECT_SOURCE_DIR}/build/models/\\1")
set(models_there "")
foreach(model IN LISTS models)
  if(EXISTS ${model})
    list(APPEND models_there ${model})
  endif()
endforeach()
if(models_there AND TARGET bodyloom_command)
  install(FILES ${models_there} ${CMAKE_CURRENT_LIST_DIR}/models.txt
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bodyloom/models COMPONENT command)
endif()
if(TARGET bodyloom_command)
  install(FILES ${PROJECT_SOURCE_DIR}/python/blender/bodyloom_blender.py
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bodyloom/blender COMPONENT command)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libbodyloom-dev COMPONENT development)
