#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/manifest_samples.hpp"
#include "manifest/halmstad.hpp"
#include "manifest/npy_array.hpp"
#include "map_server/raster_image.hpp"
#include "worlds/point_fit.hpp"

namespace gridmerge {
namespace {

using samples::npy;
using samples::npy_indices;
using samples::npy_points;
using samples::problem_of;
using samples::test_folder;
using samples::write;
namespace fs = std::filesystem;

// --- .npy files ------------------------------------------------------------------------------------------------------

NpyTable parsed(const std::string& bytes) { return parse_npy(bytes, "p.npy"); }
std::string npy_problem(const std::string& bytes) {
  return problem_of([&] { static_cast<void>(parsed(bytes)); });
}

TEST(NpyArray, ReadsNumbersOfEveryKindItNames) {
  const std::string shape = "(1, 2)";
  EXPECT_THAT(parsed(npy("<f8", shape, samples::bytes_of<double>({1.5, -2}))).values, testing::ElementsAre(1.5, -2));
  EXPECT_THAT(parsed(npy("<f4", shape, samples::bytes_of<float>({1.5F, -2}))).values, testing::ElementsAre(1.5, -2));
  EXPECT_THAT(parsed(npy("<i8", shape, samples::bytes_of<std::int64_t>({7, -1}))).values, testing::ElementsAre(7, -1));
  EXPECT_THAT(parsed(npy("<i4", shape, samples::bytes_of<std::int32_t>({7, -1}))).values, testing::ElementsAre(7, -1));
  EXPECT_THAT(parsed(npy("|u1", shape, "\x07\xff")).values, testing::ElementsAre(7, 255));
  EXPECT_THAT(parsed(npy("|i1", shape, "\x07\xff")).values, testing::ElementsAre(7, -1));
  EXPECT_THAT(parsed(npy(">i2", shape, {"\x01\x02\xff\xfe", 4})).values, testing::ElementsAre(258, -2));
}

TEST(NpyArray, ReadsByRowsAndByColumns) {
  const std::string data = samples::bytes_of<double>({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(parsed(npy("<f8", "(3, 2)", data)).at(1, 0), 3);
  EXPECT_EQ(parsed(npy("<f8", "(3, 2)", data, "True")).at(1, 0), 2);
  EXPECT_EQ(parsed(npy("<f8", "(3, 2)", data, "True")).at(0, 1), 4);
}

TEST(NpyArray, RefusesWhatIsNoTableOfNumbers) {
  EXPECT_THAT(npy_problem("PNG"), testing::StartsWith("p.npy: is no NumPy file"));
  EXPECT_THAT(npy_problem(npy("|O", "(1, 2)", "pickle")), testing::HasSubstr("holds Python objects"));
  EXPECT_THAT(npy_problem(npy("<c16", "(1, 2)", "")), testing::HasSubstr("dtype: '<c16' is neither"));
  EXPECT_THAT(npy_problem(npy("<f8", "(2,)", "")), testing::HasSubstr("shape: (2,) has not two axes"));
  EXPECT_THAT(npy_problem(npy("<f8", "(1, 1, 1)", "")), testing::HasSubstr("has not two axes"));
  EXPECT_THAT(npy_problem(npy("<f8", "(9999999999, 2)", "")), testing::HasSubstr("has not two axes"));
  EXPECT_THAT(npy_problem(npy("<f8", "(1, 2)", "12345678")),
              testing::HasSubstr("holds 8 bytes of numbers, its header asks for 16"));
  EXPECT_THAT(npy_problem(npy("<f8", "(1, 2)", "").substr(0, 40)), testing::HasSubstr("ends within its header"));
}

TEST(NpyArray, RefusesEveryShortenedFile) {
  const std::string whole = npy_points({1, 2, 3, 4});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(npy_problem(whole.substr(0, length)), "") << length;
  }
}

// --- the pose between marked points ----------------------------------------------------------------------------------

TEST(PointFit, FindsThePoseThatMovedThePoints) {
  const Pose2 target_from_source = {3, -1, 2.5};
  std::vector<PointMatch> matches;
  for (const Point2 point : {Point2{0, 0}, Point2{4, 1}, Point2{-2, 7}}) {
    matches.push_back({.in_target = target_from_source * point, .in_source = point});
  }
  const PointFit fit = fit_points(matches);
  EXPECT_NEAR(norm(fit.target_from_source.translation() - Point2{3, -1}), 0, 1e-12);
  EXPECT_NEAR(fit.target_from_source.theta_rad, 2.5, 1e-12);
  EXPECT_NEAR(fit.residual_m, 0, 1e-12);
  EXPECT_NEAR(scale_between(matches), 1, 1e-12);
}

TEST(PointFit, TellsHowFarThePointsStayApart) {
  // A square whose opposite corners are pulled out by 1: no pose takes that away.
  const std::vector<PointMatch> matches = {
      {{3, 3}, {2, 2}}, {{-3, -3}, {-2, -2}}, {{1, -1}, {2, -2}}, {{-1, 1}, {-2, 2}}};
  EXPECT_NEAR(fit_points(matches).residual_m, std::sqrt(2.0), 1e-12);
}

// --- the data set ----------------------------------------------------------------------------------------------------

const Pose2 kTruth = {0.5, 4, -kPi / 2};  ///< from B's frame to A's
constexpr double kPixel_m = 0.05;

/// Spots of the building, in A's frame [m].
std::vector<Point2> spots() { return {{1, 1}, {3, 1}, {3, 4}, {1, 4}, {2, 2.5}}; }

/// Where these spots lie in a picture, in pixels from its lower-left pixel's centre.
std::vector<double> marked(const Pose2& a_from_map, double pixel_m) {
  std::vector<double> numbers;
  for (const Point2 spot : spots()) {
    const Point2 in_map = inverse(a_from_map) * spot;
    numbers.push_back(in_map.x_m / pixel_m - 0.5);
    numbers.push_back(in_map.y_m / pixel_m - 0.5);
  }
  return numbers;
}

/// A gray picture: unknown, with a free square and a wall below it.
std::string picture(int width, int height) {
  RasterImage image = {.width = width, .height = height, .channels = 1, .samples = {}};
  image.samples.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 127);
  for (int row = height / 4; row < height / 2; ++row) {
    for (int column = width / 4; column < width / 2; ++column) {
      image.samples[static_cast<std::size_t>(row * width + column)] = row == height / 2 - 1 ? 0 : 255;
    }
  }
  return encode_png(image);
}

const std::vector<std::int64_t> kAllSpots = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4};

/// Two buildings: H with two sensor maps and a floor plan of half the scale, K with one sensor map.
fs::path repository() {
  fs::path root = test_folder("Halmstad-Robot-Maps");
  write(root / "maps/H/pseudo_occupancy/H_01.png", picture(80, 100));
  write(root / "maps/H/pseudo_occupancy/H_02.png", picture(100, 80));
  write(root / "maps/H/pseudo_occupancy/H_01.svg", "<svg/>");
  write(root / "maps/H/layout/H_layout.png", picture(40, 50));
  write(root / "maps/K/pseudo_occupancy/K_01.png", picture(60, 60));
  write(root / "annotations/keypoints_H_01.npy", npy_points(marked({}, kPixel_m)));
  write(root / "annotations/keypoints_H_02.npy", npy_points(marked(kTruth, kPixel_m)));
  write(root / "annotations/keypoints_H_layout.npy", npy_points(marked({}, 2 * kPixel_m)));
  write(root / "annotations/keypoints_K_01.npy", npy_points({1, 1}));
  write(root / "annotations/association_H_01_H_02.npy", npy_indices(kAllSpots));
  write(root / "annotations/association_H_layout_H_01.npy", npy_indices(kAllSpots));
  write(root / "annotations/association_H_02_H_layout.npy", npy_indices({4, 4, 0, 0, 2, 2, -1, 3}));
  return root;
}

const ManifestPair& pair_named(const std::vector<ManifestPair>& pairs, const std::string& target,
                               const std::string& source) {
  for (const ManifestPair& pair : pairs) {
    if (pair.target_name == target + ".yaml" && pair.source_name == source + ".yaml") {
      return pair;
    }
  }
  throw std::runtime_error("no pair " + target + " " + source);
}

void expect_pose(const ManifestPair& pair, const Pose2& target_from_source) {
  ASSERT_TRUE(pair.truth);
  const PoseDifference off = difference_at(*pair.source_centre, pair.truth->target_from_source, target_from_source);
  EXPECT_LT(off.distance_m, 1e-3);
  EXPECT_LT(off.angle_rad, 1e-5);
}

TEST(HalmstadConversion, FindsThePosesThatThePointsTell) {
  const fs::path out = test_folder("out");
  const Conversion result = convert_halmstad(repository(), out);
  EXPECT_EQ(result.maps, 4U);
  EXPECT_TRUE(result.left_out.empty()) << testing::PrintToString(result.left_out);
  const std::vector<ManifestPair> pairs = read_manifest(out / "pairs.csv");
  EXPECT_EQ(pairs.size(), 8U);
  EXPECT_EQ(result.pairs, 8U);
  expect_pose(pair_named(pairs, "H_01", "H_02"), kTruth);
  expect_pose(pair_named(pairs, "H_02", "H_01"), inverse(kTruth));
  expect_pose(pair_named(pairs, "H_01", "H_layout"), {});
  expect_pose(pair_named(pairs, "H_layout", "H_02"), kTruth);
  EXPECT_EQ(pair_named(pairs, "H_01", "H_02").tags, "rigid sensor");
  EXPECT_EQ(pair_named(pairs, "H_01", "H_layout").tags, "rigid layout");
  EXPECT_EQ(pairs[0].set, "halmstad-h");
  EXPECT_FALSE(pair_named(pairs, "H_02", "K_01").truth);
}

TEST(HalmstadConversion, KeepsWhatThePicturesShow) {
  const fs::path out = test_folder("out");
  convert_halmstad(repository(), out);
  const OccupancyGrid map = read_map(out / "H_01.yaml");
  EXPECT_EQ(map.geometry.width, 80);
  EXPECT_EQ(map.geometry.height, 100);
  EXPECT_EQ(map.geometry.resolution_m, 0.05);
  EXPECT_EQ(map.at({20, 50}), kOccupied);  // the square's last row, which is the lowest
  EXPECT_EQ(map.at({20, 51}), kFree);
  EXPECT_EQ(map.at({19, 51}), kUnknown);
  EXPECT_DOUBLE_EQ(read_map(out / "H_layout.yaml").geometry.resolution_m, 0.1);
}

TEST(HalmstadConversion, CallsAPairBentWhosePointsStayApart) {
  const fs::path root = repository();
  std::vector<double> points = marked(kTruth, kPixel_m);
  points[0] += 60;
  write(root / "annotations/keypoints_H_02.npy", npy_points(points));
  const fs::path out = test_folder("out");
  convert_halmstad(root, out, {.both_orders = false});
  const std::vector<ManifestPair> pairs = read_manifest(out / "pairs.csv");
  EXPECT_EQ(pair_named(pairs, "H_01", "H_02").tags, "bent sensor");
  EXPECT_EQ(pair_named(pairs, "H_01", "H_02").truth->tolerance_m, 1);
  EXPECT_EQ(pair_named(pairs, "H_02", "H_layout").tags, "bent layout");
}

TEST(HalmstadConversion, LeavesOutWhatHasNoUsablePointsAndSaysSo) {
  const fs::path root = repository();
  write(root / "annotations/association_H_01_H_02.npy", npy_indices({0, 0, 1, 1}));
  write(root / "annotations/association_H_02_H_layout.npy", npy_indices({0, 0, 1, 1, 2, 9}));
  fs::remove(root / "annotations/keypoints_K_01.npy");
  const fs::path out = test_folder("out");
  const Conversion result = convert_halmstad(root, out);
  EXPECT_EQ(result.maps, 3U);
  EXPECT_EQ(result.pairs, 2U);
  ASSERT_EQ(result.left_out.size(), 3U);
  EXPECT_THAT(result.left_out[0], testing::HasSubstr("keypoints_K_01.npy"));
  EXPECT_THAT(result.left_out[1], testing::HasSubstr("association_H_01_H_02.npy: holds 2 different points"));
  EXPECT_THAT(result.left_out[2], testing::HasSubstr("association_H_02_H_layout.npy: row 2: there is no point 9"));
}

TEST(HalmstadConversion, LeavesOutAFloorPlanOfUnknownScale) {
  const fs::path root = repository();
  fs::remove(root / "annotations/association_H_layout_H_01.npy");
  fs::remove(root / "annotations/association_H_02_H_layout.npy");
  const fs::path out = test_folder("out");
  const Conversion result = convert_halmstad(root, out);
  EXPECT_FALSE(fs::exists(out / "H_layout.yaml"));
  EXPECT_THAT(result.left_out.back(), testing::EndsWith("so its scale is not known"));
}

TEST(HalmstadConversion, NamesWhatIsNoCloneOfTheRepository) {
  const fs::path out = test_folder("out");
  EXPECT_THAT(problem_of([&] { convert_halmstad(out, out); }), testing::HasSubstr("is the folder that is read"));
  EXPECT_THAT(problem_of([&] { convert_halmstad(test_folder("in"), out); }),
              testing::EndsWith("has no folder maps: it must be a clone of Halmstad-Robot-Maps"));
  const fs::path root = repository();
  write(root / "maps/H/pseudo_occupancy/H_01.png", "no picture");
  write(root / "maps/K/pseudo_occupancy/K_01.png", "nor this");
  const std::string problem = problem_of([&] { convert_halmstad(root, out); });
  EXPECT_THAT(problem, testing::HasSubstr("H_01.png"));
  EXPECT_THAT(problem, testing::HasSubstr("K_01.png"));
  EXPECT_TRUE(fs::is_empty(out));
}

TEST(HalmstadConversion, RefusesARepositoryWithoutAnyPose) {
  const fs::path root = repository();
  for (const char* pair : {"H_01_H_02", "H_layout_H_01", "H_02_H_layout"}) {
    fs::remove(root / "annotations" / ("association_" + std::string(pair) + ".npy"));
  }
  EXPECT_THAT(problem_of([&] { convert_halmstad(root, test_folder("out")); }),
              testing::HasSubstr("annotations: no two maps share usable points"));
}

TEST(HalmstadConversion, WritesTheSameAtAnyNumberOfThreads) {
  const fs::path root = repository();
  const fs::path one = test_folder("one");
  const fs::path four = test_folder("four");
  convert_halmstad(root, one, {}, 1);
  convert_halmstad(root, four, {}, 4);
  for (const char* file : {"pairs.csv", "H_02.png", "H_layout.yaml"}) {
    EXPECT_EQ(samples::text_of(one / file), samples::text_of(four / file)) << file;
  }
}

TEST(HalmstadOptions, RefusesBrightnessesInTheWrongOrder) {
  EXPECT_THAT(problem_of([] { convert_halmstad(".", ".", {.occupied_up_to = 200, .free_from = 100}); }),
              "occupied_up_to: 200 must lie below free_from, 100");
  EXPECT_THROW(convert_halmstad(".", ".", {.resolution_m = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
