# bodyloom_module(NAME [PUBLIC lib...] [PRIVATE lib...] [WITHOUT folder-or-file...] [SOURCES file...])
#   One folder = one static library bodyloom_NAME with alias bodyloom::NAME, made of every .cc file in the folder and
#   below it, WITHOUT the sub-folders and files that belong to libraries of their own; or of these SOURCES alone.
#   Baseline CPU flags everywhere: Debian's libceres.a is built for SSE2, and mixing in AVX-compiled Eigen code breaks
#   its aligned allocations (docs/concepts.md, "Why no -march=native"). SIMD lives in Eigen-free *_simd.cc files that
#   pick their instruction set at run time.
function(bodyloom_module name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE;WITHOUT;SOURCES" ${ARGN})
  if(ARG_SOURCES)
    set(sources ${ARG_SOURCES})
  else()
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
    foreach(other IN LISTS ARG_WITHOUT)
      list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${other}(/|$)")
    endforeach()
  endif()
  add_library(bodyloom_${name} STATIC ${sources})
  target_include_directories(bodyloom_${name} PUBLIC
    $<BUILD_INTERFACE:${BODYLOOM_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(bodyloom_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  bodyloom_flags(bodyloom_${name})
  add_library(bodyloom::${name} ALIAS bodyloom_${name})
  set_target_properties(bodyloom_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY BODYLOOM_MODULES ${name})
endfunction()

# Headers are included as "bodyloom/tracking/track_sequence.h", in this tree, from add_subdirectory() and once installed
# alike: the build folder has a folder `bodyloom` with links to ours.
set(BODYLOOM_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${BODYLOOM_INCLUDE_DIR}/bodyloom)
foreach(folder geometry render tracking data_tools neural pipelines)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${BODYLOOM_INCLUDE_DIR}/bodyloom/${folder} SYMBOLIC)
endforeach()

# Warnings and sanitizers shared by every target of the project.
function(bodyloom_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter
    -Wno-restrict)  # g++ 12 reports std::string concatenation (GCC bug 105651)
  if(BODYLOOM_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(BODYLOOM_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${BODYLOOM_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${BODYLOOM_SANITIZE})
  endif()
endfunction()

# Headers of programs (apps/, tests/, benchmarks/) are included from the project's root.
function(bodyloom_program_headers target)
  target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()
