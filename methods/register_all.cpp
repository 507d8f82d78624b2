#include "methods/register_all.hpp"

#include "methods/genetic/genetic.hpp"
#include "methods/genetic/paper_genetic.hpp"

namespace gridmerge {
namespace {

/// A profile that runs a method with its options as they stand in their struct.
template <typename Options, typename Method>
MethodProfile profile(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [] { return std::make_unique<TypedMethodConfig<Options, Method>>(Options{}); }};
}

}  // namespace

MethodRegistry all_methods() {
  MethodRegistry registry;
  registry.add(
      {.name = "genetic",
       .summary = "a population of poses, seeded by a sweep over all poses and evolved in niches",
       .paper = "H. Li, F. Nashashibi: A new method for occupancy grid maps merging, ICARCV 2012; H. Li, M. Tsukada, "
                "F. Nashashibi, M. Parent: Multivehicle cooperative local mapping, IEEE T-ITS 15(5), 2014",
       .profiles = {profile<GeneticOptions, GeneticMerger>(
                        "default", "anywhere, any angle, no window needed; uses a prior where there is one"),
                    profile<PaperGeneticOptions, PaperGeneticMerger>(
                        "paper", "as published: a window round a start pose, mean split, mutation, two crossovers")}});
  return registry;
}

}  // namespace gridmerge
