// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/placed_knowledge.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "base/degrees.h"
#include "base/number_text.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Standard deviations of the motion between a node and the robot at a stated time.
constexpr double kMotionSigma_m = 1e-3;
constexpr double kMotionSigma_rad = radians_from_degrees(0.01L);
// A time may lie this far before the first scan of a run or after the last one.
constexpr TimeUs kTolerance_us = 200'000;

std::string sentence_start(const std::string& source) {
  return source.empty() ? "" : source + ": ";
}

std::string text_of(const KnownResidual& residual) {
  std::string text = fixed_text(residual.distance_m, 2) + " m";
  if (residual.turn_rad) text += " and " + fixed_text(mrpt::RAD2DEG(*residual.turn_rad), 1) + " degrees";
  return text;
}

std::string time_text(TimeUs time_us) {
  return format_seconds(time_us) + " s";
}

auto key_of(const MeasuredPose& measured) {
  return std::tuple(measured.pose.x, measured.pose.y, measured.pose.phi, measured.sigma_m,
                    measured.sigma_rad.value_or(0));
}

// Sorts the elements by their contents, so that the order in which they were stated has no effect.
void sort(FixedKnowledge& knowledge) {
  std::sort(knowledge.poses.begin(), knowledge.poses.end(), [](const KnownPose& a, const KnownPose& b) {
    return std::tuple(a.from_scan, a.time_us, key_of(a.site_T_robot)) <
           std::tuple(b.from_scan, b.time_us, key_of(b.site_T_robot));
  });
  std::sort(knowledge.sightings.begin(), knowledge.sightings.end(),
            [](const TagSighting& a, const TagSighting& b) {
              return std::tuple(a.name, a.from_scan, a.time_us, key_of(a.robot_T_tag)) <
                     std::tuple(b.name, b.from_scan, b.time_us, key_of(b.robot_T_tag));
            });
}

// Number of the node of a scan.
std::size_t node_of(std::size_t scan, const std::vector<std::size_t>& node_frames) {
  const auto node = std::lower_bound(node_frames.begin(), node_frames.end(), scan);
  if (node == node_frames.end() || *node != scan)
    throw std::logic_error("PlacedKnowledge: scan " + std::to_string(scan) + " is no node");
  return static_cast<std::size_t>(node - node_frames.begin());
}

// Pose of a later place relative to a node, both by the front end.
class Moments {
 public:
  Moments(const std::vector<FrameRecord>& frames, const std::vector<std::size_t>& node_frames,
          const std::vector<std::size_t>& later_run_frames)
      : frames_(frames), node_frames_(node_frames), runs_(runs_of(frames.size(), later_run_frames)) {}

  /// Number of the node before the time and the robot's pose relative to it; nothing if no run from the scan
  /// `from_scan` on has the time.
  std::optional<std::pair<std::size_t, TPose2D>> at(TimeUs time_us, std::size_t from_scan) const {
    for (const FrameSpan& run : runs_) {
      if (run.end <= from_scan || run.begin == run.end) continue;
      if (time_us < frames_[run.begin].time_us - kTolerance_us ||
          time_us > frames_[run.end - 1].time_us + kTolerance_us)
        continue;
      const auto begin = frames_.begin() + static_cast<std::ptrdiff_t>(run.begin);
      const auto end = frames_.begin() + static_cast<std::ptrdiff_t>(run.end);
      const auto after = std::upper_bound(
          begin, end, time_us, [](TimeUs time, const FrameRecord& frame) { return time < frame.time_us; });
      const auto before = after == begin ? begin : after - 1;
      TPose2D local_T_robot = before->front_end_T_robot;
      if (after != end && before != after) {
        const double share = static_cast<double>(time_us - before->time_us) /
                             static_cast<double>(after->time_us - before->time_us);
        local_T_robot = interpolate(local_T_robot, after->front_end_T_robot, share);
      }
      const auto frame = static_cast<std::size_t>(before - frames_.begin());
      const auto next_node = std::upper_bound(node_frames_.begin(), node_frames_.end(), frame);
      if (next_node == node_frames_.begin() || *(next_node - 1) < run.begin) continue;
      const auto node = static_cast<std::size_t>(next_node - node_frames_.begin()) - 1;
      return std::pair(node, between(frames_[node_frames_[node]].front_end_T_robot, local_T_robot));
    }
    return std::nullopt;
  }

  /// Complains about a time that no scan has.
  std::string complaint(const std::string& source, TimeUs time_us) const {
    std::string text =
        sentence_start(source) + "the log has no scan at " + time_text(time_us) + ", expected a time ";
    const char* before = "";
    for (const FrameSpan& run : runs_) {
      if (run.begin == run.end) continue;  // no scan was added since the run began
      text += before + ("from " + time_text(frames_[run.begin].time_us)) + " to " +
              time_text(frames_[run.end - 1].time_us);
      before = " or ";
    }
    return text + ". Correct the time; trajectory.csv lists those of the scans";
  }

 private:
  const std::vector<FrameRecord>& frames_;
  const std::vector<std::size_t>& node_frames_;
  std::vector<FrameSpan> runs_;
};

}  // namespace

PlacedKnowledge::PlacedKnowledge(FixedKnowledge knowledge, const std::vector<FrameRecord>& frames,
                                 const std::vector<std::size_t>& node_frames,
                                 const std::vector<std::size_t>& later_run_frames) {
  sort(knowledge);
  stated_ = knowledge.tags.size() + knowledge.sightings.size() +
            static_cast<std::size_t>(std::count_if(knowledge.poses.begin(), knowledge.poses.end(),
                                                   [](const KnownPose& pose) { return !pose.is_matched; }));
  const Moments moments(frames, node_frames, later_run_frames);
  const auto moment_of = [&](const auto& stated) {
    std::optional<Moment> moment;
    if (const auto found = moments.at(stated.time_us, stated.from_scan))
      moment = Moment{found->first, found->second};
    else
      complaints_.push_back(moments.complaint(stated.source, stated.time_us));
    return moment;
  };
  for (const KnownPose& pose : knowledge.poses)
    add_pose(pose, pose.scan ? Moment{node_of(*pose.scan, node_frames), {}} : moment_of(pose));
  std::set<std::string> names;
  std::vector<std::pair<TagSighting, Moment>> sightings;
  for (const TagPlace& tag : knowledge.tags) names.insert(tag.name);
  for (const TagSighting& sighting : knowledge.sightings) {
    names.insert(sighting.name);
    if (const auto moment = moment_of(sighting)) sightings.emplace_back(sighting, *moment);
  }
  for (const std::string& name : names) add_tag(name, knowledge, sightings);
}

void PlacedKnowledge::add_pose(const KnownPose& pose, const std::optional<Moment>& moment) {
  if (!moment) return;
  const MeasuredPose motion{moment->node_T_robot, kMotionSigma_m, kMotionSigma_rad};
  landmarks_.push_back({pose.site_T_robot, {{moment->node, motion}}});
  origins_.push_back({pose, {}, {}});
}

void PlacedKnowledge::add_tag(const std::string& name, const FixedKnowledge& knowledge,
                              const std::vector<std::pair<TagSighting, Moment>>& sightings) {
  Landmark landmark;
  Origin origin;
  for (const TagPlace& tag : knowledge.tags)
    if (tag.name == name) origin.place = tag;
  if (origin.place) landmark.site_T_mark = origin.place->site_T_tag;
  for (const auto& [sighting, moment] : sightings) {
    if (sighting.name != name) continue;
    MeasuredPose node_T_tag = sighting.robot_T_tag;
    node_T_tag.pose = compose(moment.node_T_robot, node_T_tag.pose);
    landmark.sightings.push_back({moment.node, node_T_tag});
    origin.sightings.push_back(sighting);
  }
  const std::size_t seen = landmark.sightings.size();
  if (origin.place && seen == 0) {
    complaints_.push_back(
        sentence_start(origin.place->source) + "tag " + name +
        " was never seen, so its place is not used. State a sighting with a line: seen name=" + name);
  } else if (!origin.place && seen == 1) {
    complaints_.push_back(sentence_start(origin.sightings.front().source) + "tag " + name +
                          " was seen only once and its place is unknown, so it is not used. State its place "
                          "or a second sighting");
  } else if (seen > 0) {
    landmarks_.push_back(std::move(landmark));
    origins_.push_back(std::move(origin));
  }
}

// Returns one sentence about all places in a prior map that the finished map contradicts.
std::optional<std::string> PlacedKnowledge::contradicted_matches(const KnownLandmarks& in_graph,
                                                                 const PoseGraph& graph,
                                                                 double max_chi) const {
  std::size_t matched = 0;
  std::size_t contradicted = 0;
  const KnownPose* worst = nullptr;
  KnownResidual worst_off;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const std::optional<KnownPose>& pose = origins_[i].pose;
    if (!pose || !pose->is_matched) continue;
    ++matched;
    const KnownResidual off = in_graph.place_residual(i, graph);
    if (in_graph.uses_place(i, graph) && off.chi <= max_chi) continue;
    ++contradicted;
    if (worst != nullptr && off.distance_m <= worst_off.distance_m) continue;
    worst = &*pose;
    worst_off = off;
  }
  if (worst == nullptr) return std::nullopt;
  const TPose2D& place = worst->site_T_robot.pose;
  return sentence_start(worst->source) + "the scans contradict this map at " + std::to_string(contradicted) +
         " of " + std::to_string(matched) + " places of the robot, most at x " + fixed_text(place.x, 1) +
         " m, y " + fixed_text(place.y, 1) + " m, where it is off by " + text_of(worst_off) +
         ". Check the walls there, and prior.sigma_m";
}

std::vector<std::string> PlacedKnowledge::contradictions(const KnownLandmarks& in_graph,
                                                         const PoseGraph& graph, double max_chi) const {
  std::vector<std::string> sentences = complaints_;
  const auto judge = [&](const std::string& source, const std::string& what, const std::string& others,
                         bool is_used, const KnownResidual& off) {
    if (!is_used)
      sentences.push_back(sentence_start(source) + what + " is left out, because the scans and " + others +
                          " contradict it: it is off by " + text_of(off) + ". Correct or remove it");
    else if (off.chi > max_chi)
      sentences.push_back(sentence_start(source) + what + " is off by " + text_of(off) +
                          " in the finished map, " + fixed_text(off.chi, 1) +
                          " stated standard deviations. Check it and its sigma_m and sigma_deg");
  };
  if (auto sentence = contradicted_matches(in_graph, graph, max_chi))
    sentences.push_back(*std::move(sentence));
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const Origin& origin = origins_[i];
    if (origin.pose && !origin.pose->is_matched)
      judge(origin.pose->source, "the pose at " + time_text(origin.pose->time_us), "the other known poses",
            in_graph.uses_place(i, graph), in_graph.place_residual(i, graph));
    if (origin.place)
      judge(origin.place->source, "the place of tag " + origin.place->name, "the other known poses",
            in_graph.uses_place(i, graph), in_graph.place_residual(i, graph));
    for (std::size_t k = 0; k < origin.sightings.size(); ++k) {
      const TagSighting& sighting = origin.sightings[k];
      judge(sighting.source, "the sighting of tag " + sighting.name + " at " + time_text(sighting.time_us),
            "the other sightings", in_graph.uses_sighting(i, k, graph),
            in_graph.sighting_residual(i, k, graph));
    }
  }
  return sentences;
}

KnowledgeCounts PlacedKnowledge::counts(const KnownLandmarks& in_graph, const PoseGraph& graph) const {
  std::size_t used = 0;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const Origin& origin = origins_[i];
    const bool states_place = origin.place || (origin.pose && !origin.pose->is_matched);
    if (states_place && in_graph.uses_place(i, graph)) ++used;
    for (std::size_t k = 0; k < origin.sightings.size(); ++k)
      if (in_graph.uses_sighting(i, k, graph)) ++used;
  }
  return {used, stated_ - used};
}

}  // namespace psi_slam
