/// gridmerge: the command line. Whatever went wrong is told here, in one place.
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "cli/program.hpp"
#include "cli/usage_error.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/library_threads.hpp"
#ifdef GRIDMERGE_WITH_BENCHMARKS
#include "commands/commands.hpp"
#endif

namespace {

int fail(const std::string& what, int status) {
  std::cerr << "gridmerge: " << what << '\n';
  return status;
}

std::vector<gridmerge::cli::CommandMaker> further_commands() {
#ifdef GRIDMERGE_WITH_BENCHMARKS
  return gridmerge::cli::benchmark_commands();
#else
  return {};
#endif
}

}  // namespace

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  using namespace gridmerge::cli;
  try {
    const int status = run_program(argc, argv, std::cout, further_commands());
    return std::cout.flush() ? status : fail("standard output: cannot be written", kInputError);
  } catch (const UsageError& error) {
    return fail(error.what(), kWrongUsage);
  } catch (const gridmerge::InputError& error) {
    return fail(error.what(), kInputError);
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory for these maps", kInputError);
  } catch (const std::exception& error) {
    return fail(error.what(), kInputError);
  }
}
