# liblo (Open Sound Control), which comes without a package file for CMake: Liblo::lo.
find_path(Liblo_INCLUDE_DIR lo/lo.h)
find_library(Liblo_LIBRARY lo)
mark_as_advanced(Liblo_INCLUDE_DIR Liblo_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Liblo REQUIRED_VARS Liblo_LIBRARY Liblo_INCLUDE_DIR)
if(Liblo_FOUND AND NOT TARGET Liblo::lo)
  add_library(Liblo::lo UNKNOWN IMPORTED)
  set_target_properties(Liblo::lo PROPERTIES
    IMPORTED_LOCATION ${Liblo_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${Liblo_INCLUDE_DIR})
endif()
