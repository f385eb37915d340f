// SPDX-License-Identifier: BSD-3-Clause
// Maps a rawlog through mrpt::slam::CMetricMapBuilder, MRPT's interface of metric SLAM.
//
//     04_mrpt_map_builder RAWLOG MAP.simplemap.gz PICTURE.png
//
// A program that uses CMetricMapBuilderICP or CMetricMapBuilderRBPF changes only the class of its builder.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>
#include <psi_slam/metric_map_builder_psi.h>

#include <iostream>

namespace {

void map_rawlog(const std::string& rawlog, const std::string& map, const std::string& picture) {
  mrpt::io::CFileGZInputStream file;
  if (!file.open(rawlog)) throw std::runtime_error("cannot open " + rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr actions;
  mrpt::obs::CSensoryFrame::Ptr observations;
  mrpt::obs::CObservation::Ptr observation;

  psi_slam::CMetricMapBuilderPsi builder;
  for (std::size_t i = 0; mrpt::obs::CRawlog::getActionObservationPairOrObservation(
           archive, actions, observations, observation, i);) {
    if (observation)
      builder.processObservation(observation);
    else
      builder.processActionObservation(*actions, *observations);
  }
  builder.finish();  // searches for the remaining loops and refines all poses
  builder.saveCurrentMapToFile(map);
  builder.saveCurrentEstimationToImage(picture);
  std::cout << builder.getCurrentlyBuiltMapSize() << " nodes\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: 04_mrpt_map_builder RAWLOG MAP.simplemap.gz PICTURE.png\n";
    return 2;
  }
  try {
    map_rawlog(argv[1], argv[2], argv[3]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "04_mrpt_map_builder: " << error.what() << '\n';
    return 1;
  }
}
