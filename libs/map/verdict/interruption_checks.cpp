// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/interruption_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace psi_slam {
namespace {

/// Walls that two passes compared.
struct WallCount {
  double same = 0;
  double seen_through = 0;

  void add(const ScanComparison& scans, double sign = 1) {
    same += sign * static_cast<double>(scans.same);
    seen_through += sign * static_cast<double>(scans.seen_through);
  }
  /// Share of the walls that are seen through, less its standard deviation; zero for fewer than `least`
  /// walls.
  double sure_share(std::size_t least) const {
    const double all = same + seen_through;
    if (all < static_cast<double>(std::max<std::size_t>(least, 1))) return 0;
    const double share = seen_through / all;
    return std::max(0.0, share - std::sqrt(share * (1 - share) / all));
  }
};

/// Stretches of frames that can be searched for an overlap.
class Stretches {
 public:
  explicit Stretches(const std::vector<FrameSpan>& all) {
    for (const FrameSpan& stretch : all) {
      begins_.push_back(stretch.begin);
      ends_.push_back(stretch.end);
    }
    std::sort(begins_.begin(), begins_.end());
    std::sort(ends_.begin(), ends_.end());
  }

  /// Whether a stretch overlaps the path from `first` to `last`.
  bool overlap(std::size_t first, std::size_t last) const {
    // All stretches that end up to `first` also begin before `last`.
    const auto begun = std::lower_bound(begins_.begin(), begins_.end(), last) - begins_.begin();
    const auto ended = std::upper_bound(ends_.begin(), ends_.end(), first) - ends_.begin();
    return begun > ended;
  }

 private:
  std::vector<std::size_t> begins_;
  std::vector<std::size_t> ends_;
};

/// Sums of the comparisons between passes across each step of the path.
class PassSums {
 public:
  PassSums(const std::vector<MapView>& views, const std::vector<PassCheck>& checks,
           const Stretches& explained)
      : views_(views), across_(views.size() + 1) {
    for (const PassCheck& check : checks) {
      const auto [first, last] = std::minmax(check.view, check.other);
      if (check.same_pass || explained.overlap(views[first].frame, views[last].frame)) continue;
      all_.add(check.scans);
      across_[first + 1].add(check.scans);
      across_[last + 1].add(check.scans, -1);
    }
    for (std::size_t view = 1; view < across_.size(); ++view) {
      across_[view].same += across_[view - 1].same;
      across_[view].seen_through += across_[view - 1].seen_through;
    }
  }

  /// Share of the walls seen through between views before a frame and views from it on; zero unless it is
  /// clearly larger than that of all other comparisons.
  double contradicted_at(std::size_t frame, std::size_t least) const {
    const auto after = std::lower_bound(views_.begin(), views_.end(), frame,
                                        [](const MapView& view, std::size_t f) { return view.frame < f; });
    const WallCount& across = across_[static_cast<std::size_t>(after - views_.begin())];
    const WallCount others{all_.same - across.same, all_.seen_through - across.seen_through};
    const double share = across.sure_share(least);
    return share > 2 * others.sure_share(least) ? share : 0;
  }

 private:
  const std::vector<MapView>& views_;
  WallCount all_;
  std::vector<WallCount> across_;  // between the view before and this view
};

/// Share of the walls that the scans on both sides of a gap see differently, beyond what people and doors
/// change.
double contradicted_across_gap(const MappingResult& result, std::size_t frame,
                               const PassCheckOptions& options) {
  const std::optional<MapView> before = view_of_frame(result, frame - 1);
  const std::optional<MapView> after = view_of_frame(result, frame);
  if (!before || !after) return 0;
  WallCount walls;
  walls.add(compare_scans(*before, *after, options.scans));
  walls.add(compare_scans(*after, *before, options.scans));
  constexpr double kChangedScene = 0.1;
  return std::max(0.0, walls.sure_share(options.min_points) - kChangedScene);
}

}  // namespace

std::vector<InterruptionCheck> check_interruptions(const MappingResult& result,
                                                   const std::vector<MapView>& views,
                                                   const std::vector<PassCheck>& checks,
                                                   const std::vector<PathSuspect>& suspects,
                                                   const std::vector<FrameSpan>& explained,
                                                   const PassCheckOptions& options) {
  const PassSums sums(views, checks, Stretches(explained));
  std::vector<InterruptionCheck> found;
  for (const PathSuspect& suspect : suspects) {
    const bool is_gap = suspect.kind == PathSuspect::Kind::kGap;
    if (!is_gap && suspect.kind != PathSuspect::Kind::kLost) continue;
    double contradicted = sums.contradicted_at(suspect.first_frame, options.min_points);
    if (is_gap)
      contradicted = std::max(contradicted, contradicted_across_gap(result, suspect.first_frame, options));
    found.push_back({suspect, contradicted});
  }
  return found;
}

}  // namespace psi_slam
