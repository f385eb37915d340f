// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/transform_tree.h"

#include <algorithm>
#include <cctype>

namespace psi_slam {

using mrpt::poses::CPose3D;

bool has_word(std::string frame, const char* word) {
  frame.erase(0, frame.rfind('/') + 1);
  std::transform(frame.begin(), frame.end(), frame.begin(), [](unsigned char c) { return std::tolower(c); });
  return frame.find(word) != std::string::npos;
}

void TransformTree::add(const RosTransform& transform) {
  if (transform.child_frame == transform.header.frame) return;
  links_[transform.child_frame] = {transform.header.frame, transform.pose};
}

std::vector<std::string> TransformTree::way_up(const std::string& frame) const {
  std::vector<std::string> way{frame};
  // A valid way up has at most as many links as the tree. A damaged tree may contain a cycle.
  while (way.size() <= links_.size()) {
    const auto link = links_.find(way.back());
    if (link == links_.end()) break;
    way.push_back(link->second.parent);
  }
  return way;
}

std::optional<std::string> TransformTree::child_of(
    const std::function<bool(const std::string& parent)>& is_parent) const {
  std::optional<std::string> found;
  for (const auto& [frame, link] : links_)
    if (is_parent(link.parent) && (!found || (has_word(frame, "base") && !has_word(*found, "base"))))
      found = frame;
  return found;
}

std::string TransformTree::parent_of(const std::string& frame) const {
  const auto link = links_.find(frame);
  return link == links_.end() ? "" : link->second.parent;
}

CPose3D TransformTree::above_T_frame(std::string frame, std::size_t steps) const {
  CPose3D pose;
  for (std::size_t i = 0; i < steps; ++i) {
    const Link& link = links_.at(frame);
    pose = link.parent_T_frame + pose;
    frame = link.parent;
  }
  return pose;
}

std::optional<CPose3D> TransformTree::base_T_frame(const std::string& base, const std::string& frame) const {
  const std::vector<std::string> above_base = way_up(base);
  const std::vector<std::string> above_frame = way_up(frame);
  for (std::size_t i = 0; i < above_frame.size(); ++i) {
    const auto meeting = std::find(above_base.begin(), above_base.end(), above_frame[i]);
    if (meeting == above_base.end()) continue;
    const auto steps = static_cast<std::size_t>(meeting - above_base.begin());
    return above_T_frame(frame, i) - above_T_frame(base, steps);
  }
  return std::nullopt;
}

std::string TransformTree::text() const {
  std::string text;
  for (const auto& [frame, link] : links_) text += (text.empty() ? "" : ", ") + frame + " < " + link.parent;
  return text.empty() ? "none" : text;
}

}  // namespace psi_slam
