// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/odometry_findings.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "base/significance.h"
#include "logs/doctor/finding_list.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::RAD2DEG;
using mrpt::math::TPose2D;

class OdometryJudge : public FindingList {
 public:
  using FindingList::FindingList;

  std::vector<Finding> findings() {
    judge_motion();
    if (diagnosis_.odometry_is_sound) {
      judge_reversals();
      judge_jumps();
      judge_correction();
      judge_delay();
      judge_mount();
      judge_beam_angles();
    }
    return std::move(findings_);
  }

 private:
  void judge_motion() {
    if (facts_.scans_without_odometry > 0) {
      note("no_odometry",
           (facts_.scans_without_odometry == facts_.scans
                ? "the scans are read without odometry"
                : counted(facts_.scans_without_odometry, "scan") +
                      (facts_.scans_without_odometry == 1 ? " has" : " have") + " no odometry") +
               "; there, the motion of the robot follows from the scans alone");
      return;
    }
    const OdometryAgreement& odometry = diagnosis_.odometry;
    const OdometryFacts& facts = facts_.odometry;
    const bool odometry_stands = facts.path_length_m < 0.02 && facts.turned_rad < 0.02;
    const bool scans_move =
        odometry.scan_path_m > 0.05 * static_cast<double>(std::max<std::size_t>(odometry.tracks, 1));
    if (odometry_stands && scans_move) {
      warn("odometry_still", "odometry never moves, but the scans do", "log.odometry = none");
      return;
    }
    if (odometry_stands) {
      note("robot_still", "the robot stands still in the whole log");
      return;
    }
    if (odometry.clock_offset) {
      judge_clock_offset(*odometry.clock_offset);
      return;
    }
    if (diagnosis_.field_of_view.finds_fault()) {
      judge_field_of_view(diagnosis_.field_of_view);
      return;
    }
    const HeadingRelation heading = heading_relation(odometry);
    judge_length(odometry, heading);
    judge_heading(odometry, heading);
    if (odometry.length_samples == 0 || odometry.heading == HeadingRelation::kUnknown) {
      note("odometry_unchecked",
           "odometry could not be checked: too few scans could be aligned, or they fit several places, "
           "as in a bare corridor");
    }
  }

  void judge_field_of_view(const FieldOfViewStudy& study) {
    const FieldOfViewFit& stated = study.fits.front();
    const FieldOfViewFit& best = study.fits[study.best];
    const auto degrees = [](const FieldOfViewFit& fit) {
      return trimmed_text(RAD2DEG(fit.field_of_view_rad), 1);
    };
    warn("field_of_view",
         "the laser has a field of view of " + degrees(best) + " degrees, not " + degrees(stated) + ": " +
             percent(best.turn_share) + " of " + counted(study.turns, "turn") +
             " are those of odometry, not " + percent(stated.turn_share) + ", and points are off walls by " +
             fixed(1000 * best.mean_distance_m, 0) + " mm after straight motion, not " +
             fixed(1000 * stated.mean_distance_m, 0) + " mm",
         "log.field_of_view_deg = " + degrees(best));
  }

  void judge_clock_offset(const ScanDelay& offset) {
    warn("clock_offset",
         "the stamps of scans and odometry differ by " + fixed(std::abs(offset.delay_s), 3) +
             " s (standard deviation " + fixed(offset.deviation_s, 3) + " s): the scans are stamped " +
             (offset.delay_s > 0 ? "later" : "earlier") +
             ". Odometry contradicts the scans as recorded, and agrees with them at shifted times",
         delay_remedy(offset.delay_s, /*can_be_estimated=*/false));
  }

  /// Settings that remove a delay. log.calibrate estimates delays of up to kMostEstimatedDelay_s.
  std::string delay_remedy(double delay_s, bool can_be_estimated) const {
    std::string remedy = can_be_estimated ? "log.calibrate = true" : "";
    if (facts_.contents.several_lasers && diagnosis_.laser.empty())  // the laser has no name
      return remedy.empty() ? "state the delay of each laser with log.scan_delay_s" : remedy;
    const std::string of_laser = diagnosis_.laser.empty() ? "" : diagnosis_.laser + " ";
    return remedy + (remedy.empty() ? "" : ", or ") + "log.scan_delay_s = " + of_laser + fixed(delay_s, 3);
  }

  HeadingRelation heading_relation(const OdometryAgreement& odometry) const {
    const bool is_degrees = odometry.heading == HeadingRelation::kDegrees ||
                            odometry.heading == HeadingRelation::kOppositeDegrees;
    return is_degrees && diagnosis_.headings_are_quaternions ? HeadingRelation::kUnrelated : odometry.heading;
  }

  void judge_length(const OdometryAgreement& odometry, HeadingRelation heading) {
    constexpr std::array<std::pair<double, const char*>, 6> kUnits{{{1000, "millimetres"},
                                                                    {100, "centimetres"},
                                                                    {39.37, "inches"},
                                                                    {3.281, "feet"},
                                                                    {0.001, "kilometres"},
                                                                    {0.01, "hundreds of metres"}}};
    const double ratio = odometry.length_ratio;
    if (ratio == 0 || (ratio > 0.6 && ratio < 1.6)) return;
    // Lengths of other times or of another robot have no common ratio.
    const bool is_unit = odometry.length_share >= 0.5;
    if (!is_unit && heading == HeadingRelation::kUnrelated) return;
    for (const auto& [per_metre, name] : kUnits) {
      if (!is_unit || std::abs(portable::log(ratio / per_metre)) > portable::log(1.3)) continue;
      warn("odometry_unit",
           "odometry moves " + fixed(ratio, ratio < 1 ? 4 : 1) +
               " times as far as the scans: it looks like " + name + ", not metres",
           "write the positions of the odometry in metres");
      return;
    }
    warn("odometry_unit",
         "odometry moves " + fixed(ratio, ratio < 0.1 ? 4 : 2) + " times as far as the scans",
         "check that odometry and ranges are in metres");
  }

  void judge_heading(const OdometryAgreement& odometry, HeadingRelation heading) {
    switch (heading) {
      case HeadingRelation::kOpposite:
        if (follows_its_heading(odometry)) {
          warn("mirrored_scan", "the scans turn right where odometry turns left: the scan is mirrored",
               std::string("log.mirrored = ") + (diagnosis_.options.mirrored ? "false" : "true"));
        } else {
          warn("odometry_clockwise",
               "odometry's headings run clockwise: they turn against the scans and against "
               "odometry's own positions",
               "write the headings of the odometry counter-clockwise");
        }
        return;
      case HeadingRelation::kDegrees:
      case HeadingRelation::kOppositeDegrees:
        warn("odometry_degrees",
             "odometry's headings turn 57 times as far as the scans: they look like degrees, not "
             "radians",
             "write the headings of the odometry in radians");
        return;
      case HeadingRelation::kNone:
        warn("odometry_never_turns", "odometry's heading does not change where the scans turn",
             "check that the log contains the heading of the odometry, in radians");
        return;
      case HeadingRelation::kUnrelated:
        warn("odometry_unrelated", "odometry's turns are unrelated to those of the scans",
             "check that odometry and scans come from the same robot and the same time");
        return;
      case HeadingRelation::kAgrees:
        judge_direction(odometry);
        return;
      case HeadingRelation::kUnknown:
        return;
    }
  }

  void judge_direction(const OdometryAgreement& odometry) {
    const double off_rad = odometry.direction_offset_rad;
    if (diagnosis_.laser_is_turned && diagnosis_.mount) return;  // see judge_mount()
    if (!moves_in_another_direction(odometry)) return;
    const double heading_rad = mrpt::math::wrapToPi(facts_.robot_T_laser.phi - off_rad);
    warn("laser_heading",
         "the scans move " + fixed(RAD2DEG(off_rad), 0) +
             " degrees away from the direction of odometry: the stated heading of the laser is wrong" +
             (follows_its_heading(odometry) ? ""
                                            : ", or those of odometry are, which moves across its headings"),
         "log.laser_yaw_deg = " + fixed(RAD2DEG(heading_rad), 0));
  }

  void judge_reversals() {
    const LostReversals& reversals = diagnosis_.reversals;
    const bool many = reversals.pairs.size() >= 4 && reversals.reversed_m > 0.003 * reversals.checked_m;
    if (!many) return;
    warn("lost_reversals",
         "odometry counts reversing as driving forwards: at " + counted(reversals.pairs.size(), "place") +
             ", " + fixed(reversals.reversed_m, 1) + " of the " + fixed(reversals.checked_m, 0) +
             " m compared, the scans move backwards where odometry moves forwards, first " +
             moment(reversals.pairs.front().first),
         "repair the odometry, or map without it: log.odometry = none");
  }

  void judge_jumps() {
    const OdometryJumps& jumps = diagnosis_.jumps;
    if (jumps.pairs.empty()) return;
    const auto first = std::min_element(jumps.pairs.begin(), jumps.pairs.end(),
                                        [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::string sentence =
        "odometry jumps at " + counted(jumps.pairs.size(), "place") + ", by up to " +
        fixed(jumps.largest_m, 2) + " m and " + fixed(RAD2DEG(jumps.largest_turn_rad), 0) +
        " degrees between two scans that show no such motion, first " + moment(first->first);
    if (share_of(jumps.pairs.size(), facts_.scans) > 0.01) {
      warn("odometry_jumps", sentence, "check whether odometry was reset or messages were lost");
    } else {
      note("odometry_jumps", sentence);
    }
  }

  void judge_correction() {
    const std::size_t two_poses = facts_.contents.scans_with_two_poses;
    const bool is_mapped = facts_.contents.second_pose_is_mapped;  // otherwise, the laser's in most scans
    if (two_poses > 0 && (is_mapped || 2 * two_poses < facts_.scans)) {
      note("two_poses", counted(two_poses, "scan") + (two_poses == 1 ? " has" : " have") +
                            " a second pose besides odometry" +
                            (is_mapped ? ", the result of a mapper" : "") + "; the odometry is used");
    }
    const RevisitAgreement& revisits = diagnosis_.revisits;
    if (revisits.agreeing < 8 || share_of(revisits.agreeing, revisits.revisits) < 0.7) return;
    warn("corrected_odometry",
         "odometry is accurate to " + fixed(100 * revisits.median_offset_m, 1) + " cm at " +
             std::to_string(revisits.agreeing) + " of " + counted(revisits.revisits, "revisit") +
             ", better than wheels allow: it looks corrected by a mapper or simulated",
         "use the raw log, and do not compare mappers on this log");
  }

  /// Heading of the laser under the best beam angles, since other beam angles imply another heading.
  double laser_yaw_rad(const LaserMountEstimate& mount) const {
    const BeamAngleStudy& study = diagnosis_.beam_angles;
    for (const BeamAngleFit& fit : study.fits) {
      if (study.knows_heading && fit.angles == study.best)
        return mrpt::math::wrapToPi(facts_.robot_T_laser.phi + fit.laser_heading_rad);
    }
    return mount.robot_T_laser.phi;
  }

  void judge_delay() {
    constexpr double kLeast_s = 0.02;
    constexpr double kLarge_s = 0.1;
    if (!diagnosis_.delay) return;
    const ScanDelay& delay = *diagnosis_.delay;
    const std::vector<StatedDelay> stated = stated_delays(diagnosis_.options);
    const auto& lasers = facts_.contents.laser_names;
    const double stated_s =
        delay_of_laser(stated, lasers.empty() ? std::vector<std::string>() : lasers.front());
    const double off_s = std::abs(delay.delay_s - stated_s);
    if (off_s < std::max(kLeast_s, kSignificantDeviations * delay.deviation_s)) return;
    const std::string sentence = "turns show that the scans are stamped " +
                                 fixed(std::abs(delay.delay_s), 3) + " s " +
                                 (delay.delay_s > 0 ? "later" : "earlier") + " than odometry (accurate to " +
                                 fixed(delay.deviation_s, 3) + " s)";
    const std::string remedy =
        delay_remedy(delay.delay_s, stated.empty());  // a stated option is not estimated
    if (off_s > kLarge_s)
      warn("scan_delay", sentence, remedy);
    else
      note("scan_delay", sentence, remedy);
  }

  void judge_mount() {
    if (!diagnosis_.mount) return;
    const LaserMountEstimate& mount = *diagnosis_.mount;
    const TPose2D& stated = facts_.robot_T_laser;
    const double yaw_rad = laser_yaw_rad(mount);
    const double off_m = distance_m(stated, mount.robot_T_laser);
    const double off_rad = std::abs(mrpt::math::wrapToPi(yaw_rad - stated.phi));
    if (off_m > std::max(0.03, kSignificantDeviations * mount.deviation_m) ||
        off_rad > std::max(DEG2RAD(0.8), kSignificantDeviations * mount.deviation_rad)) {
      const std::string x = fixed(mount.robot_T_laser.x, 3);
      const std::string y = fixed(mount.robot_T_laser.y, 3);
      const std::string yaw = fixed(RAD2DEG(yaw_rad), 2);
      const std::string sentence =
          "scans and odometry move as if the laser were at x " + x + " m, y " + y + " m, yaw " + yaw +
          " degrees on the robot (accurate to " + fixed(mount.deviation_m, 3) + " m and " +
          fixed(RAD2DEG(mount.deviation_rad), 2) + " degrees), not at x " + fixed(stated.x, 3) + " m, y " +
          fixed(stated.y, 3) + " m, yaw " + fixed(RAD2DEG(stated.phi), 2) + " degrees";
      const std::string remedy =
          "log.laser_x_m = " + x + ", log.laser_y_m = " + y + ", log.laser_yaw_deg = " + yaw;
      if (diagnosis_.laser_is_turned)
        warn("laser_heading", sentence, remedy);
      else
        note("laser_mount", sentence, remedy);
    }
    judge_scale(mount);
  }

  void judge_scale(const LaserMountEstimate& mount) {
    constexpr double kLeast = 0.01;
    constexpr double kUsual = 0.04;  // wheels that slip or wear
    const double off = std::abs(mount.odometry_scale * diagnosis_.options.odometry_scale.value_or(1) - 1);
    if (off <= std::max(kLeast, kSignificantDeviations * mount.scale_deviation)) return;
    const std::string sentence = std::string("odometry ") +
                                 (mount.odometry_scale > 1 ? "overstates" : "understates") +
                                 " distances by " + fixed(100 * std::abs(mount.odometry_scale - 1), 1) +
                                 " % (accurate to " + fixed(100 * mount.scale_deviation, 1) + " %)";
    const std::string remedy =
        std::string(diagnosis_.options.odometry_scale ? "" : "log.calibrate = true, or ") +
        "log.odometry_scale = " + fixed(1 / mount.odometry_scale, 4);
    const bool is_bent = diagnosis_.sweep_direction.stated_sweep_time_s != 0;  // which spoils the estimate
    if (off > kUsual + kSignificantDeviations * mount.scale_deviation && !is_bent)
      warn("odometry_scale", sentence, remedy);
    else
      note("odometry_scale", sentence, remedy);
  }

  void judge_beam_angles() {
    const BeamAngleStudy& study = diagnosis_.beam_angles;
    if (study.fits.empty()) return;
    const std::string best(name_of(study.best));
    const auto used = std::find_if(study.fits.begin(), study.fits.end(), [&](const BeamAngleFit& fit) {
      return fit.angles == diagnosis_.used_beam_angles;
    });
    if (study.best == diagnosis_.used_beam_angles) {
      note("beam_angles", "beam angles: " + best + " fits best, as used");
      return;
    }
    const std::string sentence =
        "beam angles: " + best + " fits best, not " + std::string(name_of(diagnosis_.used_beam_angles));
    const bool is_wrong = used != study.fits.end() && (used->ruled_out_by_walls || used->ruled_out_by_turns);
    if (is_wrong) {
      warn("beam_angles", sentence + ", which the scans rule out", "log.beam_angles = " + best);
    } else {
      note("beam_angles", sentence + ", which differs only in the heading of the laser",
           "log.beam_angles = " + best);
    }
  }
};

}  // namespace

std::vector<Finding> judge_odometry(const LogDiagnosis& diagnosis) {
  return OdometryJudge(diagnosis).findings();
}

}  // namespace psi_slam
