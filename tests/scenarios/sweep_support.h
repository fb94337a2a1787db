/// Sweep files written into a folder of the test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenarios/sweep_file.h"

namespace tarmac::scenarios {

class SweepFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("sweep-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text, const std::string& name = "s.yaml") {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  SweepFile load(const std::string& text, const std::vector<Override>& sets = {}) {
    return load_sweep(write(text), sets);
  }
  /// A sweep of one block; `lines` are the block's, indented by four.
  SweepFile load_block(const std::string& lines, const std::string& estimators = "[kiss-icp]") {
    return load("name: s\nseeds: 1\nestimators: " + estimators + "\nblocks:\n  - scenario: slalom\n" + lines);
  }
  std::string error_of(const std::string& text, const std::vector<Override>& sets = {}) {
    try {
      load(text, sets);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "no error";
  }

  static std::vector<std::string> cases(const SweepFile& sweep) {
    std::vector<std::string> names;
    for (const SweepCell& cell : sweep.cells) names.push_back(cell.case_name);
    return names;
  }
  /// The values of one parameter over the cells that have it.
  static std::vector<std::string> values(const SweepFile& sweep, const std::string& path) {
    std::vector<std::string> out;
    for (const SweepCell& cell : sweep.cells)
      for (const auto& [key, value] : cell.parameters)
        if (key == path) out.push_back(value);
    return out;
  }

  std::filesystem::path folder_;
};

}  // namespace tarmac::scenarios
