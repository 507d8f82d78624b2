#include "methods/register_all.hpp"

#include "methods/genetic/genetic.hpp"

namespace gridmerge {
namespace {

/// A profile of a method whose options differ from their defaults by nothing, or by what `change` does.
template <typename Options, typename Method>
MethodProfile profile(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [] { return std::make_unique<TypedMethodConfig<Options, Method>>(Options{}); }};
}

}  // namespace

MethodRegistry all_methods() {
  MethodRegistry registry;
  registry.add({.name = "genetic",
                .summary = "a population of poses, seeded by a sweep over all poses and evolved in niches",
                .paper = "H. Li, F. Nashashibi: A new method for occupancy grid maps merging: application to "
                         "multi-vehicle cooperative local mapping and moving object detection in outdoor environment, "
                         "ICARCV 2012; Cooperative multi-vehicle localization using split covariance intersection "
                         "filter, IEEE ITS Magazine 2013",
                .profiles = {profile<GeneticOptions, GeneticMerger>(
                    "default", "anywhere, any angle, no window needed; uses a prior where there is one")}});
  return registry;
}

}  // namespace gridmerge
