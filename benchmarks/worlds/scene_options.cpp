#include <algorithm>

#include "worlds/lidar.hpp"
#include "worlds/scene.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {
namespace {

std::vector<std::string> known_lidars() {
  std::vector<std::string> names = lidar_names();
  names.insert(names.begin(), "custom");
  return names;
}

void describe_pair(SceneOptions& scene, OptionList& list) {
  list.add("kind", scene.kind, world_kinds(),
           {"", "What the world is like.", "corridor and hall cannot be told apart from themselves, moved or turned"})
      .add("seed", scene.seed, 0, 1 << 30, {"", "From it comes all chance: the world, the routes, the noise.", ""})
      .add("relation", scene.relation, {"overlap", "two_ends", "two_worlds", "mirrored", "two_floors", "two_buildings"},
           {"",
            "How the maps relate: parts of one world; its two ends, which share nothing; two worlds of one kind; "
            "a world and its mirror image; two storeys (of `floors`); a world and a building of another kind.",
            ""})
      .add("target_share", scene.target_share, 0.05, 1,
           {"", "Share of the world that the target's robot visits, from the left.", "with source_share: the overlap"})
      .add("source_share", scene.source_share, 0.05, 1,
           {"", "Share of the world that the source's robot visits, from the right.", ""})
      .add("wanted_overlap", scene.wanted_overlap, 0, 1,
           {"", "Overlap to come near to, by a search for the two shares; 0: the shares as they are.",
            "within 0.03 where the world allows; draws the pair up to four times"})
      .add("start", scene.start, {"random", "same", "opposite", "near"},
           {"",
            "Where the robots start: each somewhere in its share; both in the middle of the world; as far left and as "
            "far right as their shares go; start_distance_m apart.",
            ""})
      .add("start_distance_m", scene.start_distance_m, 0, 100,
           {"m", "How far apart the robots start, in a straight line, where start is near.", ""})
      .add("length_m", scene.length_m, 0, 400,
           {"m", "Length of the world; 0: the kind's own. Its depth goes with it.",
            "time and maps grow with its square"})
      .add("rearranged_share", scene.rearranged_share, 0, 1,
           {"", "Share of the furniture that was moved, or taken away, before the source's robot came.",
            "for kinds with furniture: office, flat, floors"})
      .add("cleared", scene.cleared,
           {"", "All furniture was taken away before the source's robot came: its map is like a plan.",
            "for kinds with furniture"})
      .add("target_heading_deg", scene.target_heading_deg, -180, 180, {"deg", "Heading of the target's x axis.", ""})
      .add("rotation_deg", scene.rotation_deg, -180, 180,
           {"deg", "How far the source's frame is turned in the target's.", ""});
}

void describe_grid(SceneOptions& scene, OptionList& list) {
  list.add("origin_yaw_deg", scene.origin_yaw_deg, -180, 180, {"deg", "Yaw of the origin of the source's grid.", ""})
      .add("resolution_m", scene.resolution_m, 0.01, 1,
           {"m", "Side of a cell.", "half of it draws four times as many cells"})
      .add("size_cells", scene.size_cells, 0, 8192,
           {"cells",
            "Side of the square map, with the start in its middle, unknown where nobody was; 0: cropped to "
            "what is known.",
            "2048 as HectorSLAM publishes it; what lies outside is lost"})
      .add("probabilistic", scene.probabilistic, {"", "Cells of 0..100 instead of 0 or 100.", ""});
}

void describe_sight(SceneOptions& scene, OptionList& list) {
  list.add("lidar", scene.lidar, known_lidars(),
           {"", "The lidar: custom, by the four options that follow, or one that can be bought.", ""})
      .add("range_m", scene.range_m, 0.5, 100, {"m", "How far the lidar sees.", ""})
      .add("beam_step_deg", scene.beam_step_deg, 0.05, 10, {"deg", "Angle between two beams.", ""})
      .add("range_noise_m", scene.range_noise_m, 0, 1, {"m", "Standard deviation of a range.", ""})
      .add("dropout", scene.dropout, 0, 1, {"", "Share of the beams that are lost.", ""})
      .add("roll_deg", scene.roll_deg, 0, 30,
           {"deg", "Standard deviation of roll and of pitch in flight.",
            "tilted beams hit the ground: walls that are none"})
      .add("height_m", scene.height_m, 0.1, 2.9, {"m", "Height of flight.", "matters where the robot rolls"})
      .add("robots_seen", scene.robots_seen, 0, 8,
           {"", "Robots that go the other's way and are seen as discs that move.", ""})
      .add("scan_step_m", scene.scan_step_m, 0.05, 10, {"m", "Way between two scans.", "time grows with its inverse"});
}

void describe_mapping(SceneOptions& scene, OptionList& list) {
  list.add("mapping", scene.mapping, {"known", "noisy", "slam"},
           {"",
            "From which poses the map is drawn: those of odometry (the true ones, unless it drifts); these, each off "
            "by a little; or those that matching each scan to the map gives, as HectorSLAM does.",
            "slam drifts of its own, and takes two or three times as long"})
      .add("odometry", scene.odometry,
           {"", "Matching starts from where odometry says the robot is, not from where it was matched last.",
            "false is HectorSLAM as it comes: for mapping = slam, with scan_step_m of 0.1 or less"})
      .add("drift_m", scene.drift_m, 0, 1, {"m", "Standard deviation of odometry's slip after a metre.", ""})
      .add("drift_deg", scene.drift_deg, 0, 10,
           {"deg", "Standard deviation of the slip of odometry's heading after a metre.",
            "the truth holds at the start poses: drift bends the maps away from it"})
      .add("pose_noise_m", scene.pose_noise_m, 0, 1,
           {"m", "Standard deviation of each pose, along and across, where mapping is noisy.", ""})
      .add("pose_noise_deg", scene.pose_noise_deg, 0, 30,
           {"deg", "Standard deviation of each heading where mapping is noisy.", ""});
}

}  // namespace

void SceneOptions::describe(OptionList& list) {
  describe_pair(*this, list);
  describe_grid(*this, list);
  describe_sight(*this, list);
  describe_mapping(*this, list);
}

std::vector<std::string> scene_problems(SceneOptions options) {
  std::vector<std::string> problems = option_list(options).problems();
  if (!problems.empty()) {
    return problems;  // what contradicts what cannot be told yet
  }
  const SceneOptions usual;
  const auto rule = [&](bool broken, std::string problem) {
    if (broken) {
      problems.push_back(std::move(problem));
    }
  };
  rule(options.length_m > 0 && (options.length_m < 10 || !world_grows(options.kind)),
       "length_m must be 0" + (world_grows(options.kind) ? std::string(" or at least 10")
                                                         : ": " + options.kind + " comes in one length only"));
  const bool changed = options.rearranged_share > 0 || options.cleared;
  rule(changed && !world_is_furnished(options.kind),
       "rearranged_share and cleared need a kind with furniture: " + options.kind + " has none");
  rule(changed && options.relation != "overlap", "rearranged_share and cleared need relation = overlap");
  rule(options.rearranged_share > 0 && options.cleared, "what is cleared cannot be rearranged: leave out one of them");
  rule(options.relation == "two_floors" && options.kind != "floors", "relation = two_floors needs kind = floors");
  rule(options.relation == "two_ends" && (options.start == "same" || options.start == "near"),
       "relation = two_ends cannot start = " + options.start + ": the robots' parts do not meet");
  rule(options.wanted_overlap > 0 && options.wanted_overlap < 0.05, "wanted_overlap must be 0 or at least 0.05");
  rule(options.wanted_overlap > 0 && options.relation != "overlap", "wanted_overlap needs relation = overlap");
  rule(options.wanted_overlap > 0 &&
           (options.target_share != usual.target_share || options.source_share != usual.source_share),
       "target_share and source_share are found by wanted_overlap: leave them out, or it");
  rule(options.size_cells > 0 && options.size_cells < 64, "size_cells must be 0 or at least 64");
  rule(options.lidar != "custom" && (options.range_m != usual.range_m || options.beam_step_deg != usual.beam_step_deg ||
                                     options.range_noise_m != usual.range_noise_m || options.dropout != usual.dropout),
       "range_m, beam_step_deg, range_noise_m and dropout are those of lidar = custom: leave them out with " +
           options.lidar);
  rule(!options.odometry && options.mapping != "slam", "odometry = false needs mapping = slam");
  rule(!options.odometry && options.scan_step_m > 0.1, "odometry = false needs scan_step_m of 0.1 or less");
  rule(!options.odometry && (options.drift_m != 0 || options.drift_deg != 0),
       "drift_m and drift_deg are those of odometry: leave them out, or odometry = false");
  return problems;
}

}  // namespace gridmerge::worlds
