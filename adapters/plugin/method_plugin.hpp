#pragma once
/// How a shared library brings methods along: docs/plugin/ is an example.
///
///     void add_methods(gridmerge::MethodRegistry& methods) { methods.add({.name = "mine", ...}); }
///     GRIDMERGE_METHOD_PLUGIN(add_methods)
///
/// The library holds nothing of gridmerge itself: what it calls is in the program that loads it, once for all. So it
/// must come from the same headers, compiler and standard library; the two functions that the macro exports tell.
#include <array>
#include <cstddef>
#include <cstdint>

#include "gridmerge/align/registry.hpp"

#ifndef GRIDMERGE_PLUGIN_VERSION
#error "link the CMake target gridmerge::plugin: it says which gridmerge these headers belong to"
#endif

#define GRIDMERGE_PLUGIN_TEXT_OF(x) #x
#define GRIDMERGE_PLUGIN_TEXT(x) GRIDMERGE_PLUGIN_TEXT_OF(x)

#if defined(__clang__)
#define GRIDMERGE_PLUGIN_COMPILER "clang " GRIDMERGE_PLUGIN_TEXT(__clang_major__)
#elif defined(__GNUC__)
#define GRIDMERGE_PLUGIN_COMPILER "gcc " GRIDMERGE_PLUGIN_TEXT(__GNUC__)
#else
#define GRIDMERGE_PLUGIN_COMPILER "another compiler"
#endif

#if defined(_GLIBCXX_DEBUG)
#define GRIDMERGE_PLUGIN_DEBUG ", debug mode"
#else
#define GRIDMERGE_PLUGIN_DEBUG ""
#endif

#if defined(_LIBCPP_ABI_VERSION)
#define GRIDMERGE_PLUGIN_LIBRARY "libc++ " GRIDMERGE_PLUGIN_TEXT(_LIBCPP_ABI_VERSION)
#elif defined(_GLIBCXX_RELEASE)
#define GRIDMERGE_PLUGIN_LIBRARY                                                                 \
  "libstdc++ " GRIDMERGE_PLUGIN_TEXT(_GLIBCXX_RELEASE) " (C++11 strings " GRIDMERGE_PLUGIN_TEXT( \
      _GLIBCXX_USE_CXX11_ABI) GRIDMERGE_PLUGIN_DEBUG ")"
#else
#define GRIDMERGE_PLUGIN_LIBRARY "another standard library"
#endif

/// What library and program must have in common, in words. A literal: a function would be found in the program.
#define GRIDMERGE_PLUGIN_ABI \
  "gridmerge " GRIDMERGE_PLUGIN_VERSION ", " GRIDMERGE_PLUGIN_COMPILER ", " GRIDMERGE_PLUGIN_LIBRARY

namespace gridmerge {

/// The sizes of what goes to and fro, as one number: a version's headers may change before the version does.
consteval std::uint64_t plugin_layout() {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const std::size_t size :
       {sizeof(MethodRegistry), sizeof(MethodEntry),     sizeof(MethodProfile), sizeof(MethodConfig),
        sizeof(OptionList),     sizeof(OptionField),     sizeof(Merger),        sizeof(MergerTraits),
        sizeof(AlignRequest),   sizeof(PosePrior),       sizeof(Population),    sizeof(RunContext),
        sizeof(StopToken),      sizeof(IterationRecord), sizeof(View),          sizeof(SurfaceView),
        sizeof(CurvesView),     sizeof(MapView),         sizeof(Shape),         sizeof(Proposal),
        sizeof(Candidate),      sizeof(PreparedMap),     sizeof(MapLevel),      sizeof(WallPoint),
        sizeof(OccupancyGrid)}) {
    hash = (hash ^ size) * 0x100000001b3U;
  }
  return hash;
}

}  // namespace gridmerge

/// Once in a library, outside of every namespace.
/// @param add_methods  a function that takes a gridmerge::MethodRegistry& and adds the library's methods; what it
/// throws is told to the user
#define GRIDMERGE_METHOD_PLUGIN(add_methods)                                                                  \
  extern "C" {                                                                                                \
  __attribute__((visibility("default"))) const char* gridmerge_plugin_abi() { return GRIDMERGE_PLUGIN_ABI; }  \
  __attribute__((visibility("default"))) std::uint64_t gridmerge_plugin_layout() {                            \
    return gridmerge::plugin_layout();                                                                        \
  }                                                                                                           \
  __attribute__((visibility("default"))) void gridmerge_plugin_register(gridmerge::MethodRegistry* methods) { \
    add_methods(*methods);                                                                                    \
  }                                                                                                           \
  }
