#pragma once
/// A folder for each test.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace gridmerge::study {

/// An empty folder of the test that runs.
inline std::filesystem::path fresh_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace gridmerge::study
