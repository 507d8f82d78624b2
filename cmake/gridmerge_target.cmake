# What every target of the house shares: the standard, the warnings, the sanitizers, the alias.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Kind of build" FORCE)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
include(GNUInstallDirs)

function(gridmerge_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
                                           $<$<BOOL:${GRIDMERGE_WERROR}>:-Werror>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ 12 sees overlaps in "literal" + std::string that are not there (GCC bug 105651).
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(GRIDMERGE_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${GRIDMERGE_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${GRIDMERGE_SANITIZE})
  endif()
endfunction()

# gridmerge_library(core SOURCES a.cpp ...): the target gridmerge_core with the alias gridmerge::core.
function(gridmerge_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES" ${ARGN})
  add_library(gridmerge_${name} ${ARG_SOURCES})
  add_library(gridmerge::${name} ALIAS gridmerge_${name})
  set_target_properties(gridmerge_${name} PROPERTIES EXPORT_NAME ${name})
  gridmerge_flags(gridmerge_${name})
endfunction()

# gridmerge_test(target SOURCES a_test.cpp ... LIBRARIES lib ...): one GoogleTest program whose cases ctest lists.
function(gridmerge_test target)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  gridmerge_flags(${target})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} gridmerge::test_main)
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
