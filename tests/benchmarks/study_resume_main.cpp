/// study_resume: a study is killed at moments of chance, resumed, and must hold the rows of an undisturbed one.
///
///     study_resume check RUNS FOLDER   the whole check, three kills; 0: it holds
///     study_resume run RUNS FOLDER     the study alone: what is started and killed
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "gridmerge/base/library_threads.hpp"
#include "study/journal.hpp"
#include "study/runner.hpp"
#include "study_rows.hpp"

namespace {

using namespace gridmerge::study;
using Clock = std::chrono::steady_clock;

constexpr int kSeeds = 20;
constexpr int kKills = 3;

/// About so many runs, the cheapest there are.
Study study_of(int runs) {
  const std::string text =
      "name: resume\n"
      "seeds: 1.." +
      std::to_string(kSeeds) +
      "\n"
      "methods: [{name: hough_spectrum, profiles: paper, set: {pipeline.refined_candidates: 1}}]\n"
      "data:\n"
      "  - scenes: {kind: flat, seed: 1.." +
      std::to_string(std::max(1, runs / kSeeds)) + ", resolution_m: 0.2, beam_step_deg: 4, scan_step_m: 2}\n";
  return parse_study(text, "resume.yaml", {});
}

struct Quiet : ProgressSink {
  void on_progress(const Progress&) override {}
};

StudyOutcome run(int runs, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  Quiet quiet;
  RunnerOptions options;
  options.folder = folder;
  options.jobs = 2;
  return run_study(study_of(runs), options, quiet);
}

/// Starts this program anew.
pid_t start(const std::string& program, int runs, const std::filesystem::path& folder) {
  const std::vector<std::string> words = {program, "run", std::to_string(runs), folder.string()};
  std::vector<char*> arguments;
  for (const std::string& word : words) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv(program.c_str(), arguments.data());
    _exit(127);
  }
  return child;
}

std::int64_t rows_there(const std::filesystem::path& folder) {
  try {
    return static_cast<std::int64_t>(read_journal(folder).rows.size());
  } catch (const std::exception&) {
    return 0;  // killed before there was a journal
  }
}

/// Kills the study when about `rows` rows are there. @return how many were there afterwards
std::int64_t kill_at(const std::string& program, int runs, const std::filesystem::path& folder, std::int64_t rows,
                     int odd_microseconds) {
  const pid_t child = start(program, runs, folder);
  bool ended = false;
  int status = 0;
  while (!ended) {
    const auto begin = Clock::now();
    if (rows_there(folder) >= rows) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2) + 4 * (Clock::now() - begin));  // leaves it its processor
    ended = waitpid(child, &status, WNOHANG) != 0;
  }
  std::this_thread::sleep_for(std::chrono::microseconds(odd_microseconds));
  if (!ended) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  } else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("the study to be killed ended by itself, with status " + std::to_string(status));
  }
  return rows_there(folder);
}

bool check(const std::string& program, int runs, const std::filesystem::path& folder) {
  for (const char* part : {"undisturbed", "killed"}) {
    std::filesystem::remove_all(folder / part);
  }
  const auto begin = Clock::now();
  const StudyOutcome undisturbed = run(runs, folder / "undisturbed");
  const std::chrono::duration<double> took = Clock::now() - begin;
  std::cout << undisturbed.made << " runs undisturbed in " << took.count() << " s\n";

  std::random_device seed;  // other moments every time: no moment may harm
  std::mt19937 random(seed());
  std::vector<std::int64_t> moments;
  for (int i = 0; i < kKills; ++i) {
    moments.push_back(std::uniform_int_distribution<std::int64_t>(0, undisturbed.of - 1)(random));
  }
  std::sort(moments.begin(), moments.end());
  for (const std::int64_t moment : moments) {
    const int odd = std::uniform_int_distribution<int>(0, 5000)(random);
    std::cout << "killed with " << kill_at(program, runs, folder / "killed", moment, odd) << " rows\n";
  }
  const StudyOutcome resumed = run(runs, folder / "killed");
  std::cout << resumed.made << " runs made to finish it\n";

  const JournalContent expected = read_journal(folder / "undisturbed");
  const JournalContent actual = read_journal(folder / "killed");
  bool same = resumed.complete() && expected.rows.size() == actual.rows.size();
  for (std::size_t i = 0; same && i < expected.rows.size(); ++i) {
    same = in_words(timeless(expected.rows[i])) == in_words(timeless(actual.rows[i]));
    if (!same) {
      std::cout << "row " << i << " differs\n";
    }
  }
  std::cout << (same ? "the same rows\n" : "NOT the same rows\n");
  return same;
}

}  // namespace

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  const std::vector<std::string> words(argv, argv + argc);
  if (words.size() != 4 || (words[1] != "check" && words[1] != "run")) {
    std::cerr << "usage: study_resume check|run RUNS FOLDER\n";
    return 2;
  }
  try {
    const int runs = std::stoi(words[2]);
    if (words[1] == "run") {
      return run(runs, words[3]).complete() ? 0 : 1;
    }
    return check(std::filesystem::read_symlink("/proc/self/exe").string(), runs, words[3]) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "study_resume: " << error.what() << "\n";
    return 1;
  }
}
