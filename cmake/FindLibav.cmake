# ffmpeg's libraries, which come without package files for CMake: Libav::avfilter, Libav::avformat, Libav::avcodec,
# Libav::swscale, Libav::avutil.
include(FindPackageHandleStandardArgs)
set(Libav_needs "")
foreach(Libav_part avfilter avformat avcodec swscale avutil)
  find_path(Libav_${Libav_part}_INCLUDE_DIR lib${Libav_part}/${Libav_part}.h)
  find_library(Libav_${Libav_part}_LIBRARY ${Libav_part})
  mark_as_advanced(Libav_${Libav_part}_INCLUDE_DIR Libav_${Libav_part}_LIBRARY)
  list(APPEND Libav_needs Libav_${Libav_part}_LIBRARY Libav_${Libav_part}_INCLUDE_DIR)
endforeach()

find_package_handle_standard_args(Libav REQUIRED_VARS ${Libav_needs})
if(Libav_FOUND)
  foreach(Libav_part avfilter avformat avcodec swscale avutil)
    if(NOT TARGET Libav::${Libav_part})
      add_library(Libav::${Libav_part} UNKNOWN IMPORTED)
      set_target_properties(Libav::${Libav_part} PROPERTIES
        IMPORTED_LOCATION ${Libav_${Libav_part}_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${Libav_${Libav_part}_INCLUDE_DIR})
    endif()
  endforeach()
endif()
