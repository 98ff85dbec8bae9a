# bodyloom_module(NAME [PUBLIC lib...] [PRIVATE lib...] [WITHOUT folder-or-file...] [SOURCES file...])
#   One folder = one static library bodyloom_NAME with alias bodyloom::NAME, made of every .cc file in the folder and
#   below it, WITHOUT the sub-folders and files that belong to libraries of their own; or of these SOURCES alone.
#   A user's find_package(bodyloom COMPONENTS NAME) brings it, with the modules that PUBLIC names.
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
  # A SIMD file is read once for each instruction set, with its own target pragmas: it is compiled by itself.
  set(simd_sources ${sources})
  list(FILTER simd_sources INCLUDE REGEX "_simd\\.cc$")
  set_source_files_properties(${simd_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  # Our files include each other from the project's root ("tracking/track_sequence.h"), users <bodyloom/…>: include/bodyloom
  # holds a link to each folder, as the installed one holds the folders.
  target_include_directories(bodyloom_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/bodyloom> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  # Headers that only our source files include are no concern of whoever uses the library.
  list(TRANSFORM ARG_PRIVATE REPLACE "^(nlohmann_json::nlohmann_json)$" "$<BUILD_INTERFACE:\\1>")
  target_compile_features(bodyloom_${name} PUBLIC cxx_std_20)
  target_link_libraries(bodyloom_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  bodyloom_flags(bodyloom_${name})
  add_library(bodyloom::${name} ALIAS bodyloom_${name})
  set_target_properties(bodyloom_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY BODYLOOM_MODULES ${name})
  set(needs ${ARG_PUBLIC} ${ARG_PRIVATE})
  list(FILTER needs INCLUDE REGEX "^bodyloom::")
  list(TRANSFORM needs REPLACE "^bodyloom::" "")
  set_property(GLOBAL PROPERTY BODYLOOM_NEEDS_${name} ${needs})
endfunction()

# bodyloom_find(MODULE PACKAGE [argument...])
#   find_package(PACKAGE argument... REQUIRED) for a library, and for whoever uses it once it is installed.
macro(bodyloom_find module)
  find_package(${ARGN} REQUIRED)
  string(REPLACE ";" " " bodyloom_find_arguments "${ARGN}")
  set_property(GLOBAL APPEND PROPERTY BODYLOOM_FINDS_${module} "${bodyloom_find_arguments}")
endmacro()

# bodyloom::bodyloom: all libraries but those that need LibTorch.
function(bodyloom_umbrella)
  add_library(bodyloom_bodyloom INTERFACE)
  get_property(modules GLOBAL PROPERTY BODYLOOM_MODULES)
  list(FILTER modules EXCLUDE REGEX "^neural")
  list(TRANSFORM modules PREPEND bodyloom:: OUTPUT_VARIABLE libraries)
  target_link_libraries(bodyloom_bodyloom INTERFACE ${libraries})
  add_library(bodyloom::bodyloom ALIAS bodyloom_bodyloom)
  set_target_properties(bodyloom_bodyloom PROPERTIES EXPORT_NAME bodyloom)
  set_property(GLOBAL APPEND PROPERTY BODYLOOM_MODULES bodyloom)
  set_property(GLOBAL PROPERTY BODYLOOM_NEEDS_bodyloom ${modules})
endfunction()

# Warnings and sanitizers shared by every target of the project.
function(bodyloom_flags target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-unused-parameter
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # g++ 12 reports std::string concatenation (GCC bug 105651)
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
