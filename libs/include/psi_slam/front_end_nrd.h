// SPDX-License-Identifier: BSD-3-Clause
// Our front end as a node registration decider of MRPT's graph-slam engine: each scan is matched with the
// active local map, and becomes a node when the robot has moved or turned enough.
//
// A node's edges lead to the anchors of the local maps that hold its scan, not to the node before: scans that
// were matched with one map share its errors, and a chain of edges beside these would count them twice. The
// engine wants the first two nodes at once and one at a time after that; a second one that is ready waits for
// the next entry.
#pragma once

#include <mrpt/graphslam/interfaces/CNodeRegistrationDecider.h>

#include <memory>
#include <string>
#include <vector>

#include "mrpt/shared_map.h"
#include "local_maps/front_end.h"
#include "mrpt/entry_frames.h"
#include "loop_closure/local_map_constraints.h"
#include "psi_slam/mapping_result.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

class CPsiFrontEndNRD : public mrpt::graphslam::deciders::CNodeRegistrationDecider<MrptGraph> {
 public:
  CPsiFrontEndNRD();
  ~CPsiFrontEndNRD() override;

  /// See load_graphslam_settings(). Throws UserError as that does.
  void loadParams(const std::string& source_fname) override;
  void printParams() const override;

  /// Instead of what the settings say of the log: for entries that were made of a log already read.
  void set_log_options(const LogOptions& options);

  /// Throws UserError as EntryFrames.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  void getDescriptiveReport(std::string* report_str) const override;

  /// After the last entry: maps the scans that waited and ends the local maps.
  void finish();

  /// Every scan where the graph's poses put it.
  Trajectory trajectory() const;

  /// How many scans could not be matched, so that odometry stands for them.
  std::size_t unmatched() const { return unmatched_; }

  const std::shared_ptr<SharedMap>& shared_map() const { return map_; }

 protected:
  /// Of the scan that was matched last; registers it, unless it is the very first.
  bool checkRegistrationCondition() override;

 private:
  bool update(const mrpt::obs::CActionCollection::Ptr& action,
              const mrpt::obs::CSensoryFrame::Ptr& observations,
              const mrpt::obs::CObservation::Ptr& observation);
  bool add(const Frame& frame);
  void add_node();

  struct Options {
    FrontEndOptions front_end;
    LocalMapNoise local_map_noise;
  };
  Options options_;
  bool log_options_set_ = false;
  std::unique_ptr<EntryFrames> entries_;
  std::unique_ptr<FrontEnd> front_end_;
  FrontEndStep step_;  ///< of the last scan
  std::shared_ptr<SharedMap> map_;
  std::vector<FrameRecord> frames_;
  std::vector<std::size_t> node_frames_;
  double odometry_m_ = 0;
  std::size_t unmatched_ = 0;
  std::string params_text_;
};

}  // namespace psi_slam
