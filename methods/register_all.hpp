#pragma once
/// The one explicit list of methods.
#include "gridmerge/align/registry.hpp"

namespace gridmerge {

/// Every method of the house; the first, genetic, is the default.
[[nodiscard]] MethodRegistry all_methods();

}  // namespace gridmerge
