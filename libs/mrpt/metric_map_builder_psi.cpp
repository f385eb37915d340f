// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/metric_map_builder_psi.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "localization/comparison/wall_changes.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/mrpt_objects.h"
#include "map/rendering/extended_map.h"
#include "map/rendering/live_grid_map.h"
#include "map/rendering/live_poses.h"
#include "map/rendering/map_image.h"
#include "mapping/mapper_options.h"
#include "mrpt/entry_frames.h"
#include "mrpt/initial_map.h"
#include "pose_graph/newest_covariance.h"
#include "pose_graph/shared_errors.h"
#include "psi_slam/mapper.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;
using mrpt::poses::CPose2D;
using mrpt::poses::CPosePDFGaussian;

// Returns the observations that arrived with the frame's first scan, plus the scans of other lasers that
// arrived separately.
CSensoryFrame::Ptr with_all_scans(const CSensoryFrame::Ptr& kept, const Frame& frame) {
  const auto came = std::count_if(kept->begin(), kept->end(), [](const CObservation::Ptr& observation) {
    return std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(observation) != nullptr;
  });
  if (static_cast<std::size_t>(came) > frame.companions.size()) return kept;
  auto all = std::make_shared<CSensoryFrame>(*kept);
  const auto observations = range_observations(frame);
  for (std::size_t i = 1; i < observations.size(); ++i) all->insert(observations[i]);
  return all;
}

// The estimates of pose and map agree with the whole graph.
MapperOptions without_latency(const CMetricMapBuilderPsi::Options& options) {
  MapperOptions mapper = options.mapper ? *options.mapper : MapperOptions();
  mapper.latency_nodes = 0;
  return mapper;
}

}  // namespace

struct CMetricMapBuilderPsi::Implementation {
  explicit Implementation(const Options& options)
      : options_(options), mapper_options_(without_latency(options)) {
    check_log_options(options.log);
    start(CPosePDFGaussian());
  }

  void start(const CPosePDFGaussian& map_T_start) {
    start_ = map_T_start;
    given_start_ = map_T_start;
    initial_.reset();
    is_aligned_ = false;
    mapper_ = std::make_unique<Mapper>(mapper_options_);
    entries_.emplace(options_.log, "CMetricMapBuilderPsi");
    waiting_observations_.clear();
    log_.clear();
    frames_.clear();
    graph_ = {};
    node_frames_.clear();
    node_observations_.clear();
    newest_covariance_ = {};
    LiveGridOptions live;
    live.map = options_.map;
    live_map_.emplace(live);
    live_poses_ = {};
    drawn_grid_.reset();
    drawn_ = {};
    finished_ = false;
  }

  void expect_mapping(bool map_updating) const {
    if (!map_updating)
      throw UserError(
          "CMetricMapBuilderPsi: options.enableMapUpdating is false. Set it to true: psi-slam does not "
          "localise in a fixed map.");
    if (finished_)
      throw std::logic_error(
          "CMetricMapBuilderPsi: the map is finished. Call initialize() to begin another one.");
  }

  void take(const CObservation::Ptr& observation, const CSensoryFrame::Ptr& kept) {
    const std::size_t scans = entries_->scans();
    entries_->take(nullptr, nullptr, observation);
    if (entries_->scans() > scans) waiting_observations_.emplace_back(scans, kept);
    map_ready_scans();
  }

  void map_ready_scans() {
    while (std::optional<Frame> frame = entries_->next()) {
      // Skips scans of other lasers that joined an earlier frame or were dropped.
      while (waiting_observations_.front().first != entries_->opened_by()) waiting_observations_.pop_front();
      const CSensoryFrame::Ptr kept = with_all_scans(waiting_observations_.front().second, *frame);
      waiting_observations_.pop_front();
      const std::size_t index = frame->index;
      if (!mapper_->add(*std::move(frame)).node) continue;
      node_frames_.push_back(index);
      node_observations_.push_back(kept);
      follow_initial_map();
    }
  }

  // Moves the map to the place of the robot in the initial map, if the newest node shows it.
  void follow_initial_map() {
    if (!initial_) return;
    const std::optional<MeasuredPose> initial_T_run = initial_->follow(*mapper_);
    if (!initial_T_run) return;
    Eigen::Matrix3d covariance = initial_T_run->further;
    const double sigma_m = initial_T_run->sigma_m;
    const double sigma_rad = initial_T_run->sigma_rad.value_or(0);
    covariance.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
    start_ = CPosePDFGaussian(CPose2D(initial_T_run->pose), mrpt::math::CMatrixDouble33(covariance));
  }

  // Lets the mapper place the run in the initial map. Returns why it cannot, a sentence.
  std::optional<std::string> align() {
    if (!initial_) return std::nullopt;
    mapper_->end_log();
    PriorPlaces places = initial_->places(*mapper_);
    if (!places.objection.empty()) {
      start_ = given_start_;  // a place that was found while mapping is refused, too
      return "the run does not fit initial_map: " + places.objection + ". The map contains the run alone";
    }
    FixedKnowledge knowledge;
    knowledge.poses = std::move(places.poses);
    mapper_->set_knowledge(std::move(knowledge));
    start_ = CPosePDFGaussian();
    is_aligned_ = true;
    return std::nullopt;
  }

  // Returns what contradicts the initial map, as sentences.
  std::vector<std::string> finish() {
    if (finished_) return {};
    entries_->end_of_log();
    map_ready_scans();
    const std::optional<std::string> refusal = align();
    MappingResult result = mapper_->finish();
    if (refusal) result.contradictions.push_back(*refusal);
    graph_ = mapper_->graph();
    mapper_.reset();
    newest_covariance_ = {};
    log_ = std::move(result.log);
    frames_ = std::move(result.frames);
    finished_ = true;
    return std::move(result.contradictions);
  }

  // Whether poses are in the frame of an initial map.
  bool shows_initial_map() const { return finished_ ? is_aligned_ : initial_ && initial_->is_found(); }

  const std::vector<Frame>& log() const { return finished_ ? log_ : mapper_->log(); }
  const std::vector<FrameRecord>& frames() const { return finished_ ? frames_ : mapper_->frames(); }
  const PoseGraph& graph() const { return finished_ ? graph_ : mapper_->graph(); }

  CPosePDFGaussian estimate() const {
    if (frames().empty()) return start_;
    CPosePDFGaussian robot(CPose2D(frames().back().map_T_robot));
    Eigen::Matrix3d covariance = is_aligned_ ? pose_covariance(graph(), node_observations_.size() - 1)
                                             : newest_covariance_.update(graph());
    const double sigma_m = mapper_options_.path_noise.scan_sigma_m;
    const double sigma_rad = mapper_options_.path_noise.scan_sigma_rad;
    covariance.diagonal() += Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
    robot.cov = mrpt::math::CMatrixDouble33(covariance);
    CPosePDFGaussian estimate = start_;
    estimate += robot;
    return estimate;
  }

  // Returns the robot's pose at each scan in the result of finish().
  std::vector<TPose2D> final_poses() const {
    std::vector<TPose2D> poses;
    for (const FrameRecord& frame : frames_)
      poses.push_back(compose(start_.mean.asTPose(), frame.map_T_robot));
    return poses;
  }

  // Returns the grid of all scans. Before finish(), draws only what has changed since the last call. Changes
  // the object of an earlier call if only the metric map holds it and `may_change_metric_map` is true.
  COccupancyGridMap2D::Ptr up_to_date_grid(bool may_change_metric_map) const {
    if (!finished_) return live_grid(may_change_metric_map);
    if (!drawn_finished_) {
      drawn_grid_ = draw_grid_map(log_, final_poses(), options_.map);
      if (is_aligned_ && drawn_grid_->getResolution() == initial_->grid().getResolution())
        drawn_grid_ = extended_map(initial_->grid(), *drawn_grid_, WallChangeOptions().tolerance_m);
    }
    drawn_finished_ = true;
    return drawn_grid_;
  }

  COccupancyGridMap2D::Ptr live_grid(bool may_change_metric_map) const {
    drawn_finished_ = false;
    const std::size_t work = live_map_->work();
    live_poses_.take(frames());
    const auto pose = [&](std::size_t i) {
      return compose(start_.mean.asTPose(), live_poses_.map_T_robot(i, frames(), graph().poses()));
    };
    do live_map_->update(log(), pose);
    while (!live_map_->is_complete());
    if (drawn_grid_ && live_map_->work() == work) return drawn_grid_;
    GridSnapshot now = live_map_->snapshot();
    const bool is_ours =
        may_change_metric_map && holds_drawn_grid() && !drawn_grid_is_out_ && drawn_grid_.use_count() == 2;
    if (!is_ours || !update_grid(drawn_, now, *drawn_grid_)) {
      drawn_grid_ = grid_of(now);
      drawn_grid_is_out_ = false;
    }
    drawn_ = std::move(now);
    return drawn_grid_;
  }

  bool holds_drawn_grid() const {
    return drawn_grid_ && metric_map_.maps.size() == 1 && metric_map_.maps.front() == drawn_grid_;
  }

  const mrpt::maps::CMultiMetricMap& metric_map() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    up_to_date_grid(true);
    if (!holds_drawn_grid()) {
      metric_map_.maps.clear();
      metric_map_.maps.push_back(drawn_grid_);
    }
    return metric_map_;
  }

  const Options options_;
  const MapperOptions mapper_options_;
  mutable std::mutex mutex_;  // protects all members below

  CPosePDFGaussian start_;
  CPosePDFGaussian given_start_;
  std::optional<InitialMap> initial_;  // empty without an initial map
  bool is_aligned_ = false;            // whether the finished map has the frame of the initial map
  std::unique_ptr<Mapper> mapper_;     // null after finish()
  std::optional<EntryFrames> entries_;
  // Observations that are not mapped yet. Each entry has the index of the scan with which these arrived.
  std::deque<std::pair<std::size_t, CSensoryFrame::Ptr>> waiting_observations_;

  std::vector<std::size_t> node_frames_;
  std::vector<CSensoryFrame::Ptr> node_observations_;
  std::vector<Frame> log_;  // log_, frames_ and graph_: set by finish()
  std::vector<FrameRecord> frames_;
  PoseGraph graph_;
  bool finished_ = false;

  mutable NewestCovariance newest_covariance_;
  mutable std::optional<LiveGridMap> live_map_;
  mutable LivePoses live_poses_;
  mutable COccupancyGridMap2D::Ptr drawn_grid_;
  mutable GridSnapshot drawn_;  // content of drawn_grid_ before finish()
  mutable bool drawn_finished_ = false;
  mutable bool drawn_grid_is_out_ =
      false;  // whether grid() has returned drawn_grid_, which never changes then
  mutable mrpt::maps::CMultiMetricMap metric_map_;
};

CMetricMapBuilderPsi::CMetricMapBuilderPsi(const Options& psi_options)
    : implementation_(std::make_unique<Implementation>(psi_options)) {
  setLoggerName("CMetricMapBuilderPsi");
}

CMetricMapBuilderPsi::CMetricMapBuilderPsi() : CMetricMapBuilderPsi(Options()) {}

CMetricMapBuilderPsi::~CMetricMapBuilderPsi() = default;

void CMetricMapBuilderPsi::initialize(const mrpt::maps::CSimpleMap& initial_map,
                                      const mrpt::poses::CPosePDF* x0) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  Implementation& m = *implementation_;
  std::optional<InitialMap> initial;
  if (!initial_map.empty())
    initial.emplace(initial_map, m.options_.log, m.options_.map, m.mapper_options_.back_end.loop_consensus);
  m.start(x0 != nullptr ? CPosePDFGaussian(*x0) : m.estimate());
  m.initial_ = std::move(initial);
  if (m.initial_ && x0 != nullptr) m.initial_->start_at(m.start_.mean.asTPose());
}

void CMetricMapBuilderPsi::processActionObservation(mrpt::obs::CActionCollection& action,
                                                    CSensoryFrame& observations) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  implementation_->expect_mapping(options.enableMapUpdating);
  implementation_->entries_->take(std::make_shared<mrpt::obs::CActionCollection>(action), nullptr, nullptr);
  implementation_->map_ready_scans();
  // Copies the list of observations, since the caller may reuse the frame. The observations are shared.
  const auto kept = std::make_shared<CSensoryFrame>(observations);
  for (const CObservation::Ptr& observation : *kept) implementation_->take(observation, kept);
}

void CMetricMapBuilderPsi::processObservation(const CObservation::Ptr& observation) {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  implementation_->expect_mapping(options.enableMapUpdating);
  if (!observation)
    throw std::invalid_argument("CMetricMapBuilderPsi::processObservation: the observation is null");
  auto frame = CSensoryFrame::Create();
  frame->insert(observation);
  implementation_->take(observation, frame);
}

void CMetricMapBuilderPsi::finish() {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  for (const std::string& sentence : implementation_->finish()) logStr(mrpt::system::LVL_WARN, sentence);
}

mrpt::poses::CPose3DPDF::Ptr CMetricMapBuilderPsi::getCurrentPoseEstimation() const {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  return std::make_shared<mrpt::poses::CPose3DPDFGaussian>(implementation_->estimate());
}

void CMetricMapBuilderPsi::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const {
  const Implementation& m = *implementation_;
  const std::lock_guard<std::mutex> lock(m.mutex_);
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  out_map.clear();
  if (m.shows_initial_map()) out_map = m.initial_->frames();
  for (std::size_t node = 0; node < m.node_observations_.size(); ++node) {
    const CPosePDFGaussian pose(CPose2D(compose(m.start_.mean.asTPose(), m.graph().pose(node))), covariance);
    out_map.insert(std::make_shared<mrpt::poses::CPose3DPDFGaussian>(pose), m.node_observations_[node]);
  }
}

unsigned int CMetricMapBuilderPsi::getCurrentlyBuiltMapSize() {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  const Implementation& m = *implementation_;
  const std::size_t earlier = m.shows_initial_map() ? m.initial_->frames().size() : 0;
  return static_cast<unsigned int>(earlier + m.node_observations_.size());
}

#if MRPT_VERSION >= 0x292
const mrpt::maps::CMultiMetricMap& CMetricMapBuilderPsi::getCurrentlyBuiltMetricMap() const {
  return implementation_->metric_map();
}
#else
const mrpt::maps::CMultiMetricMap* CMetricMapBuilderPsi::getCurrentlyBuiltMetricMap() const {
  return &implementation_->metric_map();
}
#endif

COccupancyGridMap2D::ConstPtr CMetricMapBuilderPsi::grid() const {
  const std::lock_guard<std::mutex> lock(implementation_->mutex_);
  const COccupancyGridMap2D::Ptr grid = implementation_->up_to_date_grid(false);
  implementation_->drawn_grid_is_out_ = true;
  return grid;
}

#if MRPT_VERSION >= 0x030000
void CMetricMapBuilderPsi::saveCurrentEstimationToImage(const std::string& file) {
#else
void CMetricMapBuilderPsi::saveCurrentEstimationToImage(const std::string& file, bool /*format_emf_bmp*/) {
#endif
  const COccupancyGridMap2D::ConstPtr grid = this->grid();
  if (std::filesystem::path(file).extension() == ".png") {
    write_map_image(file, *grid);
  } else if (!grid->saveAsBitmapFile(file)) {
    throw SystemFailure("cannot write " + file);
  }
}

}  // namespace psi_slam
