// SPDX-License-Identifier: BSD-3-Clause
// Maps in MRPT's own formats, gzipped as its programs expect them. Equal maps give equal bytes.
#pragma once

#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/serialization/CSerializable.h>

#include <filesystem>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns the nodes of the graph with their scans. Each pose has the covariance (1 mm)^2, (1 mrad)^2 as a
/// placeholder that MRPT can invert, because the marginals of the graph are not computed.
mrpt::maps::CSimpleMap simple_map(const MappingResult& result);

/// Writes a simple map or a grid map, serialised and gzipped, atomically. MRPT's programs and
/// CSimpleMap::loadFromFile read it. Throws SystemFailure if the file cannot be written.
void write_mrpt_map(const std::filesystem::path& path, const mrpt::serialization::CSerializable& map);

}  // namespace psi_slam
