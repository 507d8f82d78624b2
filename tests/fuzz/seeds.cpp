// Writes a few small files for the fuzzers to start from: `fuzz_seeds FOLDER` fills FOLDER/image and FOLDER/yaml.
#include <filesystem>
#include <string>

#include "map_server/map_files.hpp"

int main(int argc, char** argv) {
  using namespace gridmerge;
  if (argc != 2) {
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder / "image");
  std::filesystem::create_directories(folder / "yaml");
  for (int channels = 1; channels <= 4; ++channels) {
    RasterImage image{5, 3, channels, {}};
    for (int i = 0; i < 15 * channels; ++i) {
      image.samples.push_back(static_cast<std::uint8_t>(51 * i));
    }
    write_whole_file(folder / "image" / ("channels" + std::to_string(channels) + ".png"), encode_png(image));
  }
  write_whole_file(folder / "image/plain.pgm", "P2 # comment\n3 2\n15\n0 1 2\n3 4 15\n");
  write_whole_file(folder / "image/raw.pgm", encode_pgm({2, 2, 1, {0, 205, 254, 255}}));
  write_whole_file(folder / "image/wide.pgm", "P5\n1 2\n300\n\1\2\1\3");
  write_whole_file(folder / "yaml/map.yaml",
                   "image: m.pgm\nmode: scale\nresolution: 0.05\norigin: [-1, 2.5, .1]\nnegate: 0\n"
                   "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  write_whole_file(folder / "yaml/config.yaml",
                   "method: toy\nrate: 0.25\ntoy: {flag: true, count: 5}\nother:\n  policy: \"off\"\n  - &a [1, 2]\n");
}
