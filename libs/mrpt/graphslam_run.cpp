// SPDX-License-Identifier: BSD-3-Clause
// The only file that instantiates MRPT's engine, which is a template.
#include "mrpt/graphslam_run.h"

#include <fcntl.h>
#include <mrpt/graphslam/CGraphSlamEngine.h>
#include <mrpt/graphslam/misc/CWindowManager.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include "base/atomic_file.h"
#include "base/atomic_folder.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/mrpt_objects.h"
#include "map/exports/mapped_trajectory.h"
#include "mrpt/graphslam_settings.h"
#include "mrpt/log_entries.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using mrpt::graphs::TNodeID;
using mrpt::math::TPose2D;

/// Redirects standard input to /dev/null while the object exists. MRPT 2.5.8's engine warns that it does not
/// recognise the class of its own graph, and would wait for a key.
class NoStandardInput {
 public:
  NoStandardInput() : kept_(::dup(STDIN_FILENO)) {
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (nothing < 0) return;
    ::dup2(nothing, STDIN_FILENO);
    if (nothing != STDIN_FILENO) ::close(nothing);
  }
  ~NoStandardInput() {
    if (kept_ < 0) {
      ::close(STDIN_FILENO);
    } else {
      ::dup2(kept_, STDIN_FILENO);
      ::close(kept_);
    }
  }
  NoStandardInput(const NoStandardInput&) = delete;
  NoStandardInput& operator=(const NoStandardInput&) = delete;

 private:
  int kept_ = -1;
};

/// The window that MRPT's graph-slam engine draws into.
class GraphSlamWindow {
 public:
  /// Opens the window. Throws UserError if there is no display.
  GraphSlamWindow() {
    constexpr unsigned kWidth_px = 800;
    constexpr unsigned kHeight_px = 600;
    const char* const display = std::getenv("DISPLAY");
    if (display == nullptr || *display == '\0')
      throw UserError(
          "no display for the window: DISPLAY is not set. Run without a window: --disable-visuals.");
    window_ = std::make_unique<mrpt::gui::CDisplayWindow3D>("psi-graphslam", kWidth_px, kHeight_px);
    observer_.observeBegin(*window_);
    observer_.observeBegin(*window_->get3DSceneAndLock()->getViewport("main"));
    window_->unlockAccess3DScene();
    manager_.setCDisplayWindow3DPtr(window_.get());
    manager_.setWindowObserverPtr(&observer_);
  }

  mrpt::graphslam::CWindowManager& manager() { return manager_; }

  /// Returns when the user has closed the window or pressed Ctrl+C in it.
  void wait_until_closed() {
    constexpr std::chrono::milliseconds kPause(100);
    std::map<std::string, bool> events;
    while (window_->isOpen() && !events["Ctrl+c"]) {
      std::this_thread::sleep_for(kPause);
      window_->forceRepaint();
      observer_.returnEventsStruct(&events, /*reset_keypresses=*/false);
    }
  }

 private:
  mrpt::graphslam::CWindowObserver observer_;
  std::unique_ptr<mrpt::gui::CDisplayWindow3D> window_;
  mrpt::graphslam::CWindowManager manager_;
};

/// MRPT's engine, extended by drawing the final map.
class Engine : public mrpt::graphslam::CGraphSlamEngine<MrptGraph> {
 public:
  template <class... Arguments>
  explicit Engine(Arguments&&... arguments) : CGraphSlamEngine(std::forward<Arguments>(arguments)...) {
    m_time_logger.setMinLoggingLevel(getMinLoggingLevel());  // m_time_logger prints when destroyed
  }

  /// Draws the map at the graph's current poses. Removes nodes registered before the first scan, for which
  /// MRPT would follow a null pointer.
  mrpt::maps::COccupancyGridMap2D::Ptr draw_map() {
    for (auto node = m_nodes_to_laser_scans2D.begin(); node != m_nodes_to_laser_scans2D.end();)
      node = node->second ? std::next(node) : m_nodes_to_laser_scans2D.erase(node);
    m_map_is_cached = false;
    auto map = mrpt::maps::COccupancyGridMap2D::Create();
    getMap(map);
    return map;
  }

  /// Writes the reports of the engine and the deciders, and closes the log files that MRPT would keep open.
  void write_reports(const fs::path& folder) {
    generateReportFiles(folder.string());
    m_out_streams.clear();
  }
};

/// Returns the result of `work`, which calls MRPT's engine. Passes UserError on, and throws SystemFailure for
/// errors of MRPT.
template <class Work>
auto in_engine(const Work& work) {
  try {
    return work();
  } catch (const UserError&) {
    throw;
  } catch (const mrpt::ExceptionWithCallBackBase& failure) {
    std::string words = failure.originalWhat.substr(failure.originalWhat.find_first_not_of("\r\n "));
    throw SystemFailure("MRPT's graph-slam engine failed: " + words.substr(0, words.find('\n')));
  }
}

/// Checks the format of a ground truth file, because MRPT does not. Returns the number of poses. Throws
/// UserError for a line without four numbers.
std::size_t check_ground_truth(const fs::path& path) {
  constexpr std::size_t kWords = 4;
  std::ifstream file(path);
  if (!file) throw UserError(path.string() + " cannot be read, expected a ground truth file. Check the path");
  std::size_t lines = 0;
  for (std::string line; std::getline(file, line);) {
    ++lines;
    std::istringstream words(line);
    std::vector<double> values;
    for (double value = 0; words >> value;) values.push_back(value);
    if (values.size() != kWords || !words.eof())
      throw UserError(path.string() + ':' + std::to_string(lines) +
                      ": expected \"time x y theta\", the true pose at a time. Correct the line");
  }
  return lines;
}

/// Calls a writer of MRPT, which may add suffixes to the file name. The files appear complete or not at all.
void write_named(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  write_files_atomically(path.parent_path(),
                         [&](const fs::path& temporary) { write(temporary / path.filename()); });
}

/// Throws SystemFailure, naming `path`, if the file `png` is missing or lacks the final chunk of a PNG file.
void require_whole_png(const fs::path& png, const fs::path& path) {
  constexpr std::string_view kEnd("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  std::ifstream file(png, std::ios::binary);
  std::string end(kEnd.size(), ' ');
  file.seekg(-static_cast<std::streamoff>(kEnd.size()), std::ios::end);
  if (!file.read(end.data(), static_cast<std::streamsize>(end.size())) || end != kEnd)
    throw SystemFailure("cannot write " + path.string() +
                        ": the file is incomplete. Check whether the disk is full");
}

mrpt::obs::CObservation2DRangeScan::Ptr scan_of(const LogEntry& entry) {
  if (entry.observations)
    return entry.observations->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
  return std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(entry.observation);
}

class EngineRun : public GraphSlamRun {
 public:
  EngineRun(const GraphSlamSetup& setup, const DeciderCatalogue& catalogue)
      : general_(read_graphslam_general(setup.ini)),
        log_(setup.log),
        node_decider_(catalogue.make_node_decider(setup.node_decider)),
        edge_decider_(catalogue.make_edge_decider(setup.edge_decider)),
        optimizer_(catalogue.make_optimizer(setup.optimizer)) {
    connect_deciders(*node_decider_, *edge_decider_, *optimizer_);
    if (!setup.ground_truth.empty()) true_poses_ = check_ground_truth(setup.ground_truth);
    const LogOptions options = log_options(read_graphslam_settings(setup.ini));
    if (options.calibrate)
      throw UserError("psi-graphslam does not calibrate. Leave log.calibrate out of " + setup.ini.string() +
                      ", and state the values that psi-slam check finds");
    entries_ = open_log_entries(setup.log, options);
    front_end_ = dynamic_cast<CPsiFrontEndNRD*>(node_decider_.get());
    if (front_end_ != nullptr && entries_->are_made()) {
      LogOptions of_made_entries;
      const LogContents contents = open_log_reader(setup.log, options)->contents();
      if (combines_lasers(contents, options, detect_log_format(setup.log))) of_made_entries.laser = "all";
      if (!entries_->have_odometry()) of_made_entries.odometry = "none";
      front_end_->set_log_options(of_made_entries);
    }
    if (setup.visuals) window_ = std::make_unique<GraphSlamWindow>();
    const NoStandardInput no_input;
    in_engine([&] {
      engine_ = std::make_unique<Engine>(setup.ini.string(), setup.log.string(), setup.ground_truth.string(),
                                         window_ ? &window_->manager() : nullptr, node_decider_.get(),
                                         edge_decider_.get(), optimizer_.get());
    });
  }

  bool step() override {
    if (at_end_ || broken_off_) return false;
    try {
      return map_next_entry();
    } catch (const UserError& error) {
      if (scans_ == 0) throw;
      broken_off_ = error.what();
      return false;
    }
  }

  void finish(const std::function<bool(double)>& progress) override {
    if (front_end_ != nullptr && scans_ == 0)
      throw UserError(log_.string() +
                      ": no scan was read, so there is nothing to map. Choose a log with 2D laser scans");
    interrupted_ = !at_end_ && !broken_off_;
    finish_deciders(*node_decider_, *edge_decider_, *optimizer_, [&](double share) {
      if (!progress || progress(share)) return true;
      interrupted_ = true;
      return false;
    });
  }

  const std::optional<std::string>& broken_off() const override { return broken_off_; }
  bool interrupted() const override { return interrupted_; }

  Trajectory trajectory() const override {
    if (front_end_ != nullptr) return trajectory_of(front_end_->frames());
    const auto& nodes = engine_->getGraph().nodes;
    Trajectory path;
    for (const PathPose& pose : path_) {
      const auto node = nodes.find(pose.node);
      const TPose2D map_T_node = node == nodes.end() ? TPose2D(0, 0, 0) : node->second.asTPose();
      path.push_back({pose.time_us, compose(map_T_node, pose.node_T_robot)});
    }
    return path;
  }

  std::map<std::string, int> edge_counts() const override {
    std::map<std::string, int> counts;
    edge_decider_->getEdgesStats(&counts);
    return counts;
  }

  std::size_t unmatched_scans() const override { return front_end_ != nullptr ? front_end_->unmatched() : 0; }

  // MRPT does not report a full disk. Therefore psi-slam writes the trajectory and the graph itself, and
  // checks that the image of the map is complete.
  void write(const OutputFolder& folder) override {
    write_tum(folder.path() / "trajectory.tum", trajectory());
    if (general_.save_graph) {
      std::ostringstream graph;
      engine_->getGraph().writeAsText(graph);
      write_text_atomically(folder.path() / general_.save_graph_fname, graph.str());
    }
    const fs::path prefix = folder.path() / general_.save_map_fname;
    if (general_.save_map && !engine_->getGraph().nodes.empty())
      write_named(prefix, [&](const fs::path& temporary) {
        engine_->draw_map()->saveMetricMapRepresentationToFile(temporary.string());
        require_whole_png(temporary.string() + ".png", prefix.string() + ".png");
      });
    if (window_ && general_.save_3DScene)
      write_named(folder.path() / general_.save_3DScene_fname, [&](const fs::path& file) {
        const std::string scene = file.string();
        engine_->save3DScene(&scene);
      });
    write_files_atomically(folder.path(), [&](const fs::path& temporary) {
      in_engine([&] { engine_->write_reports(temporary); });
    });
  }

  const MrptGraph& graph() const override { return engine_->getGraph(); }
  double progress() const override { return entries_->progress(); }
  std::size_t scans() const override { return scans_; }
  void wait_for_window() override {
    if (window_) window_->wait_until_closed();
  }

 private:
  struct PathPose {
    TimeUs time_us = 0;
    TNodeID node = 0;
    TPose2D node_T_robot;
  };

  bool map_next_entry() {
    std::optional<LogEntry> entry = entries_->next();
    at_end_ = !entry;
    if (!entry) return false;
    if (true_poses_ && steps_ >= *true_poses_)
      throw UserError("the ground truth file ends after " + std::to_string(*true_poses_) +
                      " poses, before the log does. Give one pose for each entry of the log");
    const auto scan = scan_of(*entry);
    const bool go_on = in_engine([&] {
      return engine_->_execGraphSlamStep(entry->action, entry->observations, entry->observation, steps_);
    });
    ++steps_;
    if (scan && front_end_ == nullptr) keep_path(*scan);
    if (scan) ++scans_;
    return go_on;
  }

  void keep_path(const mrpt::obs::CObservation2DRangeScan& scan) {
    const std::optional<TimeUs> time = time_us(scan);
    if (!time)
      throw UserError(log_.string() + ": scan " + std::to_string(scans_ + 1) +
                      " has no time stamp, expected one on every scan. Record the log with time stamps.");
    const auto& nodes = engine_->getGraph().nodes;
    const TNodeID node = nodes.empty() ? 0 : nodes.size() - 1;
    const TPose2D map_T_node = nodes.empty() ? TPose2D(0, 0, 0) : nodes.at(node).asTPose();
    path_.push_back({*time, node, between(map_T_node, engine_->getCurrentRobotPosEstimation().asTPose())});
  }

  const GraphSlamGeneral general_;
  const fs::path log_;
  std::unique_ptr<NodeDecider> node_decider_;
  std::unique_ptr<EdgeDecider> edge_decider_;
  std::unique_ptr<GraphOptimizer> optimizer_;
  CPsiFrontEndNRD* front_end_ = nullptr;  // null if the node decider is MRPT's
  std::unique_ptr<LogEntries> entries_;
  std::optional<std::size_t> true_poses_;
  std::unique_ptr<GraphSlamWindow> window_;
  std::unique_ptr<Engine> engine_;
  std::size_t steps_ = 0;
  std::size_t scans_ = 0;
  bool at_end_ = false;
  std::optional<std::string> broken_off_;
  bool interrupted_ = false;
  std::vector<PathPose> path_;  // filled only with MRPT's node deciders
};

}  // namespace

std::unique_ptr<GraphSlamRun> make_graphslam_run(const GraphSlamSetup& setup,
                                                 const DeciderCatalogue& catalogue) {
  return std::make_unique<EngineRun>(setup, catalogue);
}

}  // namespace psi_slam
