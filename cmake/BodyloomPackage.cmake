# `cpack` (./dev package): Debian packages.
#   bodyloom         the command without the verbs that need LibTorch
#   bodyloom-neural  those verbs
#   bodyloom-cgal    what `bodyloom body info --check` does by CGAL (GPL)
#   python3-bodyloom the Python module
#   libbodyloom-dev  the libraries and their headers
# What the programs need of Debian is read off their shared libraries (dpkg-shlibdeps, from dpkg-dev).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bodyloom)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Bodyloom authors")
set(CPACK_PACKAGE_CONTACT "The Bodyloom authors <authors@bodyloom.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_COMPONENTS_ALL development)
foreach(component command neural cgal python)
  if((component STREQUAL command AND TARGET bodyloom_command) OR
     (component STREQUAL neural AND TARGET bodyloom_neural_command) OR
     (component STREQUAL cgal AND TARGET bodyloom_cgal_command) OR
     (component STREQUAL python AND TARGET bodyloom_python))
    list(APPEND CPACK_COMPONENTS_ALL ${component})
  endif()
endforeach()

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME bodyloom)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS libavdevice59)  # loaded when a camera is opened: shlibdeps does not see it
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "bodyloom-neural, bodyloom-cgal")
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "Follows a person through a single-camera video with a parametric body.")

set(CPACK_DEBIAN_NEURAL_PACKAGE_NAME bodyloom-neural)
set(CPACK_DEBIAN_NEURAL_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_NEURAL_PACKAGE_DEPENDS "bodyloom (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_NEURAL_DESCRIPTION "Verbs of the bodyloom command that train and run neural renderers (LibTorch).")

set(CPACK_DEBIAN_CGAL_PACKAGE_NAME bodyloom-cgal)
set(CPACK_DEBIAN_CGAL_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_CGAL_PACKAGE_DEPENDS "bodyloom (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_CGAL_DESCRIPTION "Crossing faces and holes of body meshes, for bodyloom body info --check (CGAL, GPL).")

# The module is of one version of Python, whose name its file bears.
if(TARGET bodyloom_python)
  get_directory_property(minor DIRECTORY ${PROJECT_SOURCE_DIR}/python DEFINITION Python_VERSION_MINOR)
  math(EXPR next_minor "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${minor}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-bodyloom)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "bodyloom, python3-matplotlib")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Bodyloom for Python: tracks, live tracking, descriptors and pictures as NumPy arrays.")

# The libraries are static: whoever links them needs what they need.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbodyloom-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libavcodec-dev, libavdevice-dev, libavfilter-dev, libavformat-dev, libavutil-dev, libceres-dev, libcpp-httplib-dev, libdnnl-dev, libeigen3-dev, libhwy-dev, liblo-dev, \
libmatio-dev, libopencv-dev, \
libopenmesh-dev, libswscale-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS libtorch-dev)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Libraries and headers of Bodyloom, for find_package(bodyloom).")
include(CPack)
