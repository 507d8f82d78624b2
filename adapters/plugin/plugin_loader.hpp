#pragma once
/// Methods from shared libraries.
#include <filesystem>
#include <vector>

#include "gridmerge/align/registry.hpp"

namespace gridmerge {

/// The methods, and after them those of the libraries, in the order given; a library named twice is taken once. What is
/// loaded stays loaded to the end of the process, for its methods may be in use until then.
///
/// A library is code: it runs with all the rights of the program, from the moment it is loaded.
/// @param files  relative ones to the working directory; never looked for elsewhere
/// @throws InputError naming the file and the rule: it does not exist, is no shared library that can be loaded, no
/// gridmerge plugin, built for another gridmerge, compiler or standard library; it fails to register its methods, adds
/// none, or one without a proper name or with a name that is taken
[[nodiscard]] MethodRegistry with_plugins(const MethodRegistry& methods,
                                          const std::vector<std::filesystem::path>& files);

}  // namespace gridmerge
