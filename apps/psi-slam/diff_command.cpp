// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <ostream>

#include "base/atomic_file.h"
#include "base/atomic_folder.h"
#include "base/exit_code.h"
#include "base/number_text.h"
#include "base/portable_math.h"
#include "commands.h"
#include "localization/comparison/change_picture.h"
#include "localization/comparison/change_report.h"
#include "localization/reference_map.h"
#include "psi_slam/user_error.h"
#include "session/session_file.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

constexpr double kToleranceCells = 3;  // the least tolerance, in cells of the coarser map
constexpr double kSigmas = 2;  // the tolerance grows by this many standard deviations of the alignment

/// Returns the map file that `path` names: a file, or the map in a results folder. Throws UserError if the
/// path does not exist, or names a session or a folder without a map.
std::filesystem::path map_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::status(path, ignored).type() == std::filesystem::file_type::not_found)
    throw UserError(path.string() +
                    " does not exist, expected the results folder of a run, map.yaml or map.gridmap.gz. "
                    "Check the path");
  if (is_session_file(path))
    throw UserError(path.string() + " is a session, expected a map. Map it with psi-slam --resume " +
                    path.string() + " -o DIR, and name DIR");
  if (!std::filesystem::is_directory(path, ignored)) return path;
  for (const char* name : {"map.yaml", "map.gridmap.gz"})
    if (std::filesystem::exists(path / name, ignored)) return path / name;
  throw UserError(
      path.string() +
      ": the folder has no map, expected map.yaml or map.gridmap.gz. Name the results folder of a "
      "run, or a map");
}

double parse_length(const std::string& option, const std::string& text) {
  constexpr double kMost_m = 100;
  const auto length_m = parse_number(text);
  if (!length_m || *length_m <= 0 || *length_m > kMost_m)
    throw UserError(option + ' ' + text + ": expected a length in metres, above 0 and at most 100");
  return *length_m;
}

MapAlignment align(const CommandLine& line, const Grid& a, const Grid& b) {
  if (line.diff.aligned) return {};
  MapAlignmentOptions options;
  if (!line.start.empty()) options.a_T_b = parse_start(line.start);
  try {
    return align_maps(a, b, options);
  } catch (const UserError& error) {
    throw UserError(line.inputs[0] + " and " + line.inputs[1] + ": the second map " + error.what());
  }
}

/// Largest distance from the centre of the alignment to a corner of map A, in metres.
double farthest_m(const Grid& a, const MapAlignment& alignment) {
  double farthest = 0;
  for (const float x : {a.getXMin(), a.getXMax()})
    for (const float y : {a.getYMin(), a.getYMax()})
      farthest = std::max(farthest, portable::hypot(static_cast<double>(x) - alignment.centre.x,
                                                    static_cast<double>(y) - alignment.centre.y));
  return farthest;
}

MapComparison compare(const CommandLine& line, const Grid& a, const Grid& b) {
  MapComparison comparison;
  if (!line.diff.tolerance_m.empty())
    comparison.limits.tolerance_m = parse_length("--tolerance-m", line.diff.tolerance_m);
  else
    comparison.limits.tolerance_m =
        kToleranceCells * static_cast<double>(std::max(a.getResolution(), b.getResolution()));
  if (!line.diff.min_length_m.empty())
    comparison.limits.min_length_m = parse_length("--min-length-m", line.diff.min_length_m);
  comparison.alignment = align(line, a, b);
  comparison.limits.tolerance_m +=
      kSigmas * comparison.alignment.sigma_m(farthest_m(a, comparison.alignment));
  comparison.walls = find_wall_changes(a, b, comparison.alignment.a_T_b, comparison.limits);
  if (comparison.walls.compared_m2 == 0)
    throw UserError(line.inputs[0] + " and " + line.inputs[1] +
                    ": the maps share no space, expected maps of one building" +
                    (line.diff.aligned ? ". Leave out --aligned to align them" : ""));
  return comparison;
}

}  // namespace

int compare_maps(const CommandLine& line, const Streams& streams) {
  if (!line.output.empty()) OutputFolder::check(line.output, line.force);
  const Grid a = read_map_file(map_file(line.inputs[0]));
  const Grid b = read_map_file(map_file(line.inputs[1]));
  const MapComparison comparison = compare(line, a, b);
  if (!line.output.empty()) {
    const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
    write_files_atomically(folder.path(), [&](const std::filesystem::path& temporary) {
      write_text_atomically(temporary / "diff.png", change_picture(comparison.walls));
      write_text_atomically(temporary / "diff.csv", changes_csv(comparison.walls.changes));
      write_text_atomically(temporary / "diff.json", comparison_json(comparison));
    });
  }
  if (line.json)
    streams.out << comparison_json(comparison);
  else if (!line.quiet)
    streams.out << comparison_text(comparison);
  return comparison.changed() ? kExitDifferent : kExitDone;
}

}  // namespace psi_slam
