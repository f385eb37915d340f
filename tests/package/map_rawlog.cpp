// SPDX-License-Identifier: BSD-3-Clause
// Maps a rawlog: map_rawlog RAWLOG MAP.simplemap.gz PICTURE.png
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>
#include <psi_slam/metric_map_builder_psi.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: map_rawlog RAWLOG MAP PICTURE\n";
    return 2;
  }
  mrpt::io::CFileGZInputStream file(argv[1]);
  auto archive = mrpt::serialization::archiveFrom(file);
  psi_slam::CMetricMapBuilderPsi builder;
  mrpt::obs::CActionCollection::Ptr actions;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr single;
  for (std::size_t i = 0;
       mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, actions, frame, single, i);)
    single ? builder.processObservation(single) : builder.processActionObservation(*actions, *frame);
  builder.finish();
  builder.saveCurrentMapToFile(argv[2]);
  builder.saveCurrentEstimationToImage(argv[3]);
  std::cout << builder.getCurrentlyBuiltMapSize() << " nodes\n";
}
