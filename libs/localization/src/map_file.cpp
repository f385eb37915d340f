// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/localization/map_file.h"

#include <mrpt/containers/yaml.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <string>
#include <vector>

#include "psi_slam/base/compressed_file.h"
#include "psi_slam/base/user_error.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Grid read_yaml(const std::filesystem::path& path) {
  CompressedFile readable(path);  // says what is wrong with a file that is not there
  Grid grid;
  double yaw_rad = 0;
  try {
    const auto yaml = mrpt::containers::yaml::FromFile(path.string());
    yaw_rad = yaml["origin"](2).as<double>();
    if (!grid.loadFromROSMapServerYAML(path.string()))
      throw UserError(path.string() + ": the image that it names cannot be read");
  } catch (const UserError&) {
    throw;
  } catch (const std::exception&) {
    throw UserError(path.string() +
                    ": no map for map_server, which names image, resolution, origin, negate, occupied_thresh "
                    "and free_thresh");
  }
  if (yaw_rad != 0) throw UserError(path.string() + ": a map whose origin is turned cannot be used");
  return grid;
}

std::vector<char> all_bytes(const std::filesystem::path& path) {
  CompressedFile file(path);
  std::vector<char> bytes;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::size_t read = kBlock;
  while (read > 0) {
    bytes.resize(bytes.size() + kBlock);
    read = file.read(bytes.data() + bytes.size() - kBlock, kBlock);
    bytes.resize(bytes.size() - kBlock + read);
  }
  return bytes;
}

Grid read_gridmap(const std::filesystem::path& path) {
  const std::vector<char> bytes = all_bytes(path);
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  Grid grid;
  try {
    mrpt::serialization::archiveFrom(stream) >> grid;
  } catch (const std::exception&) {
    throw UserError(path.string() + ": no whole gridmap of MRPT");
  }
  return grid;
}

}  // namespace

Grid read_map_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const bool is_yaml = ends_with(name, ".yaml") || ends_with(name, ".yml");
  if (!is_yaml && !ends_with(name, ".gridmap.gz") && !ends_with(name, ".gridmap"))
    throw UserError(path.string() + " is no map: expected map.yaml or map.gridmap.gz as a run writes them");
  Grid grid = is_yaml ? read_yaml(path) : read_gridmap(path);
  const auto& cells = grid.getRawMap();
  if (std::none_of(cells.begin(), cells.end(), [](Grid::cellType cell) { return cell < 0; }))
    throw UserError(path.string() + ": a map without a single wall");
  return grid;
}

}  // namespace psi_slam
