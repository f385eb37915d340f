// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/body_masked_source.h"

#include <mrpt/core/bits_math.h>

#include <map>
#include <utility>

#include "base/number_text.h"

namespace psi_slam {
namespace {

/// Says which sectors of one laser are masked. The mount tells the laser from others.
std::string sentence_of(const std::vector<BodySector>& sectors) {
  double width_rad = 0;
  for (const BodySector& sector : sectors) width_rad += sector.width_rad;
  const mrpt::math::TPose2D& mount = sectors.front().robot_T_laser;
  return "the laser at x " + fixed_text(mount.x, 2) + " m, y " + fixed_text(mount.y, 2) +
         " m sees the robot itself in " + fixed_text(mrpt::RAD2DEG(width_rad), 1) + " degrees (" +
         text_of(sectors) + "), so these readings are ignored. Keep them with log.mask_own_body=off";
}

}  // namespace

void BodyMaskedSource::look_ahead() {
  mask_ = find_own_body(source_, most_s_);
  source_.rewind();
  std::map<std::size_t, std::vector<BodySector>> by_laser;
  for (const BodySector& sector : mask_.sectors()) by_laser[sector.laser].push_back(sector);
  for (const auto& [laser, sectors] : by_laser) sentences_.push_back(sentence_of(sectors));
}

std::optional<Frame> BodyMaskedSource::next() {
  if (!std::exchange(started_, true)) look_ahead();
  std::optional<Frame> frame = source_.next();
  if (!frame) return frame;
  mask_.apply(frame->scan);
  for (CompanionScan& companion : frame->companions) mask_.apply(companion.scan);
  return frame;
}

std::vector<std::string> BodyMaskedSource::assumptions() const {
  std::vector<std::string> assumptions = source_.assumptions();
  assumptions.insert(assumptions.end(), sentences_.begin(), sentences_.end());
  return assumptions;
}

}  // namespace psi_slam
