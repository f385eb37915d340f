// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "logs/doctor/clock_jumps.h"
#include "logs/doctor/finding_list.h"
#include "logs/doctor/odometry_findings.h"

namespace psi_slam {
namespace {

constexpr double kFarMedian_m = 100;  // beyond the median return of any 2D lidar

class Judge : public FindingList {
 public:
  using FindingList::FindingList;

  std::vector<Finding> findings() {
    judge_reading();
    judge_time();
    judge_ranges();
    judge_sweep();
    judge_own_body();
    for (Finding& finding : judge_odometry(diagnosis_)) findings_.push_back(std::move(finding));
    std::stable_sort(findings_.begin(), findings_.end(),
                     [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
    return std::move(findings_);
  }

 private:
  void judge_reading() {
    if (!facts_.broken_off.empty()) {
      warn("broken_off",
           facts_.broken_off + "; all other findings refer to the " + counted(facts_.scans, "scan") +
               " that could be read",
           "fetch the log again, or map the readable part");
    }
    if (facts_.contents.skipped.count > 0) note("skipped_lines", facts_.contents.skipped.sentence());
    if (!facts_.contents.repeated_scans.empty())
      warn("repeated_readings", facts_.contents.repeated_scans,
           "check the power supply, the connection and the driver of the laser");
    for (const std::string& assumption : facts_.contents.assumptions) note("assumption", assumption);
  }

  void judge_clock() {
    const std::vector<ClockJump> jumps = clock_jumps(diagnosis_.marks, facts_.time.median_period_s,
                                                     /*has_odometry=*/facts_.scans_without_odometry == 0);
    if (jumps.empty()) return;
    const ClockJump& first = jumps.front();
    std::string sentence = "the clock jumps by " + fixed(first.jump_s, 1) + " s, " + moment(first.frame - 1);
    if (jumps.size() > 1) sentence += ", and at " + counted(jumps.size() - 1, "later scan");
    warn("clock_jumps", sentence,
         "correct the time stamps of the log, or record it again with a clock that is not set meanwhile");
  }

  void judge_time() {
    judge_clock();
    const TimeFacts& time = facts_.time;
    constexpr double kShown_s = 0.0005;  // shorter steps are rounded stamps
    if (time.largest_backward_step_s >= kShown_s) {
      note("time_backwards", "time runs backwards at " + counted(time.backward_steps, "scan") +
                                 ", by up to " + fixed(time.largest_backward_step_s, 3) +
                                 " s; scans keep the order of the file");
    }
    if (time.gaps > 0) {
      note("time_gaps",
           counted(time.gaps, "gap") + " in time, the largest of " + fixed(time.largest_gap_s, 2) + " s");
    }
    if (time.repeated_scans > 0) {
      warn("repeated_scans",
           counted(time.repeated_scans, "scan") + (time.repeated_scans == 1 ? " repeats" : " repeat") +
               " the time and ranges of the previous scan: the log was merged "
               "or converted incorrectly",
           "remove the repeated lines");
    }
    if (time.repeated_stamps > time.repeated_scans) {
      note("repeated_stamps", counted(time.repeated_stamps - time.repeated_scans, "scan") +
                                  (time.repeated_stamps - time.repeated_scans == 1 ? " has" : " have") +
                                  " the time of the previous scan but other ranges");
    }
  }

  void judge_max_range() {
    const MaxRange& found = diagnosis_.max_range;
    const std::optional<double> stated_m = diagnosis_.options.max_range_m;
    if (found.code_m == 0) return;
    if (!stated_m) {
      if (found.is_surprise) note("no_return_code", sentence_of(found));
    } else if (*stated_m > found.code_m) {
      warn("max_range",
           "the laser writes " + fixed(found.code_m, 2) + " m for \"no return\", but log.max_range_m is " +
               fixed(*stated_m, 2) + " m",
           "log.max_range_m = auto");
    }
  }

  void judge_ranges() {
    const RangeFacts& ranges = facts_.ranges;
    const double returns = ranges.return_share();
    const auto max_range_m = static_cast<double>(ranges.max_range_m);
    if (facts_.scans_of_other_shape > 0) {
      note("changing_beams", counted(facts_.scans_of_other_shape, "scan") +
                                 (facts_.scans_of_other_shape == 1 ? " has" : " have") +
                                 " another number of beams than the "
                                 "first scan, which has " +
                                 std::to_string(facts_.beams));
    }
    const auto median_m = static_cast<double>(ranges.median_return_m);
    const bool few = returns < 0.2;
    if ((few || median_m > kFarMedian_m) && ranges.largest_reading_m > 500) {
      warn("range_unit",
           "readings go up to " + fixed(static_cast<double>(ranges.largest_reading_m), 0) + " and " +
               (few ? "only " + percent(returns) + " of them are below the maximum of " +
                          fixed(max_range_m, 2) + " m"
                    : "the median return is " + fixed(median_m, 0) + " m") +
               ": they look like millimetres or centimetres",
           "write the ranges in metres");
      return;
    }
    judge_max_range();
    if (returns < 0.3 && 2 * ranges.invalid > ranges.readings - ranges.returns) {
      note("few_returns", "only " + percent(returns) + " of the readings are returns, and " +
                              percent(share_of(ranges.invalid, ranges.readings)) +
                              " are zero, invalid or below the minimum range, as some lasers write for "
                              "\"no return\"");
    } else if (returns < 0.3) {
      warn("few_returns",
           "only " + percent(returns) + " of the readings are returns below the maximum of " +
               fixed(max_range_m, 2) + " m",
           "check that log.max_range_m is the maximum range of the sensor");
    }
    if (ranges.empty_scans > 0) {
      const std::string sentence =
          counted(ranges.empty_scans, "scan") + (ranges.empty_scans == 1 ? " has" : " have") + " no returns";
      if (share_of(ranges.empty_scans, facts_.scans) > 0.05) {
        warn("empty_scans", sentence,
             "check that log.max_range_m and log.min_range_m are the limits of the sensor");
      } else {
        note("empty_scans", sentence);
      }
    }
  }

  void judge_sweep() {
    const SweepDirectionStudy& study = diagnosis_.sweep_direction;
    if (study.shows_no_sweep()) {
      warn("sweep_time",
           "scans measured in turns fit each other best as recorded, although the sweep time is " +
               fixed(std::abs(study.stated_sweep_time_s), 3) + " s",
           "log.sweep_time_s = 0");
      return;
    }
    const SweepDirection direction = study.direction();
    if (direction == SweepDirection::kAuto) return;
    const bool backward = direction == SweepDirection::kBackward;
    const std::string sentence = std::string("turns show that the ") + (backward ? "last" : "first") +
                                 " beam of each scan is measured first, ";
    const std::string remedy = std::string("log.sweep_direction = ") + (backward ? "backward" : "forward");
    const SweepDirection used = diagnosis_.options.sweep_direction;
    if (used != SweepDirection::kAuto && used != direction) {
      warn("sweep_direction",
           sentence + "but log.sweep_direction states the " + (backward ? "first" : "last"), remedy);
    } else if (used == SweepDirection::kAuto && backward != (study.stated_sweep_time_s < 0)) {
      note("sweep_direction",
           sentence + "but the log states the " + (backward ? "first" : "last") + "; mapping corrects this",
           remedy);
    } else {
      note("sweep_direction", sentence + "as used");
    }
  }

  void judge_own_body() {
    const std::vector<BodySector>& sectors = diagnosis_.own_body;
    if (sectors.empty()) return;
    const bool one_beam = sectors.size() == 1 && sectors.front().beams == 1;
    const std::string sentence = text_of(sectors) + (one_beam ? " sees" : " see") + " the robot itself";
    if (diagnosis_.options.mask_own_body)
      note("own_body", sentence + "; mapping ignores these readings unless log.mask_own_body = off");
    else
      warn("own_body", sentence, "log.mask_own_body = auto");
  }
};

}  // namespace

std::vector<Finding> judge(const LogDiagnosis& diagnosis) {
  return Judge(diagnosis).findings();
}

}  // namespace psi_slam
