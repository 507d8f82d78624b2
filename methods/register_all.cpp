#include "methods/register_all.hpp"

#include "methods/correlative/correlative.hpp"
#include "methods/features/features.hpp"
#include "methods/features/paper_features.hpp"
#include "methods/genetic/genetic.hpp"
#include "methods/genetic/paper_genetic.hpp"
#include "methods/hough_spectrum/hough_spectrum.hpp"
#include "methods/hough_spectrum/paper_hough_spectrum.hpp"
#include "methods/radon_voronoi/paper_radon_voronoi.hpp"
#include "methods/radon_voronoi/radon_voronoi.hpp"
#include "methods/random_walk/paper_random_walk.hpp"
#include "methods/random_walk/random_walk.hpp"
#include "methods/som/paper_som.hpp"
#include "methods/som/som.hpp"

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
  registry.add(
      {.name = "hough_spectrum",
       .summary = "rotations from Hough spectra, translations from X- and Y-spectra, the best of them climbed",
       .paper = "S. Carpin: Fast and accurate map merging for multi-robot systems, Autonomous Robots 25(3), 2008",
       .profiles = {profile<HoughSpectrumOptions, HoughSpectrumMerger>(
                        "default", "spectra by facing and stretch, sub-degree rotations; any angle, no window needed"),
                    profile<PaperHoughSpectrumOptions, PaperHoughSpectrumMerger>(
                        "paper", "as published: one best translation a rotation, ranked by the acceptance index")}});
  registry.add(
      {.name = "random_walk",
       .summary = "adaptive random walks over the dissimilarity of two maps, coarse to fine",
       .paper = "S. Carpin, A. Birk, V. Jucikas: On map merging, Robotics and Autonomous Systems 53, 2005; A. Birk, "
                "S. Carpin: Merging occupancy grid maps from multiple robots, Proceedings of the IEEE 94(7), 2006",
       .profiles = {profile<RandomWalkOptions, RandomWalkMerger>(
                        "default", "many walks over a pyramid, distances truncated; at its best with a prior"),
                    profile<PaperRandomWalkOptions, PaperRandomWalkMerger>(
                        "paper", "as published: one walk, Manhattan distances of all known cells")}});
  registry.add(
      {.name = "radon_voronoi",
       .summary = "rotation from Radon transforms, translation from the edges of Voronoi diagrams",
       .paper =
           "S. Saeedi, L. Paull, M. Trentini, M. Seto, H. Li: Efficient map merging using a probabilistic "
           "generalized Voronoi diagram, IROS 2012; the same: Group mapping: a topological approach to map merging "
           "for multiple robots, IEEE Robotics & Automation Magazine 21(2), 2014",
       .profiles = {
           profile<RadonVoronoiOptions, RadonVoronoiMerger>(
               "default", "several rotations by directed Radon transforms, votes of edges and vertices, climb"),
           profile<PaperRadonVoronoiOptions, PaperRadonVoronoiMerger>(
               "paper", "as published: one rotation, thinning by morphology, edge matrices, no climb")}});
  registry.add(
      {.name = "som",
       .summary = "clusters learnt by a self-organising map, turned by their normals, moved by their votes",
       .paper = "S. Saeedi, L. Paull, M. Trentini, H. Li: Neural network-based multiple robot simultaneous "
                "localization and mapping, IEEE Trans. Neural Networks 22(12), 2011",
       .profiles = {profile<SomOptions, SomMerger>("default", "anywhere, any angle; uses a prior where there is one"),
                    profile<PaperSomOptions, PaperSomMerger>(
                        "paper", "as published: on-line learning, matched normals, closest points")}});
  registry.add(
      {.name = "correlative",
       .summary = "every pose of a lattice is scored, and the best one proved to be the best",
       .paper = "E. Olson: Real-time correlative scan matching, ICRA 2009; W. Hess, D. Kohler, H. Rapp, D. Andor: "
                "Real-time loop closure in 2D LIDAR SLAM, ICRA 2016",
       .profiles = {profile<CorrelativeOptions, CorrelativeMerger>(
                        "default", "walls on walls both ways, walls in free space cost; the best poses climb on"),
                    profile<PaperCorrelativeOptions, CorrelativeMerger>(
                        "paper", "Olson 2009: the source's walls in the target's smooth field, the lattice's best")}});
  registry.add({.name = "features",
                .summary = "keypoints matched and a rigid pose by RANSAC: what most do today, our baseline inside",
                .paper = "J. Horner: Map-merging for multi-robot system, Bachelor's thesis, Charles University in "
                         "Prague, 2016; M. A. Fischler, R. C. Bolles: Random sample consensus, 1981",
                .profiles = {profile<FeaturesOptions, FeaturesMerger>(
                                 "default", "AKAZE and ORB, many hypotheses; each climbs a little"),
                             profile<PaperFeaturesOptions, PaperFeaturesMerger>(
                                 "paper", "ORB, ratio test and one RANSAC, as the merging nodes for ROS do it")}});
  return registry;
}

}  // namespace gridmerge
