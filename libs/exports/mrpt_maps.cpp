// SPDX-License-Identifier: BSD-3-Clause
#include "exports/mrpt_maps.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include "base/atomic_file.h"
#include "compression/compression.h"
#include "observations/mrpt_objects.h"

namespace psi_slam {
mrpt::maps::CSimpleMap simple_map(const MappingResult& result) {
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  mrpt::maps::CSimpleMap map;
  for (const std::size_t frame : result.node_frames) {
    auto observations = mrpt::obs::CSensoryFrame::Create();
    for (const auto& observation : range_observations(result.log.at(frame)))
      observations->insert(observation);
    const mrpt::poses::CPose2D pose(result.frames.at(frame).map_T_robot);
    map.insert(mrpt::poses::CPosePDFGaussian::Create(pose, covariance), observations);
  }
  return map;
}

void write_mrpt_map(const std::filesystem::path& path, const mrpt::serialization::CSerializable& map) {
  constexpr std::size_t kGrowByBytes = 1 << 22;
  mrpt::io::CMemoryStream stream;
  stream.setAllocBlockSize(kGrowByBytes);
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  write_text_atomically(path, gzipped(stream.getRawBufferData(), stream.getTotalBytesCount()));
}

}  // namespace psi_slam
