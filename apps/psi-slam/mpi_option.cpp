// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_option.h"

#include <algorithm>
#include <iterator>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr const char* kMpi = "--mpi";

}  // namespace

void add_mpi_option(CLI::App& command, const std::string& words) {
  command
      .add_flag_callback(
          kMpi, [words] { throw UserError("write the command before its options: " + words + " --mpi ..."); },
          "Make the runs on the ranks of an MPI job: mpirun -n 9 " + words + " --mpi ...")
      ->disable_flag_override();
}

std::optional<std::vector<std::string>> mpi_arguments(const std::vector<std::string>& arguments,
                                                      const std::string& command) {
  if (arguments.empty() || arguments.front() != command) return std::nullopt;
  const auto end_of_options = std::find(arguments.begin(), arguments.end(), "--");
  if (std::find(arguments.begin(), end_of_options, kMpi) == end_of_options) return std::nullopt;
  std::vector<std::string> rest;
  std::remove_copy(arguments.begin(), end_of_options, std::back_inserter(rest), kMpi);
  rest.insert(rest.end(), end_of_options, arguments.end());
  return rest;
}

}  // namespace psi_slam
