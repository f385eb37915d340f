// SPDX-License-Identifier: BSD-3-Clause
#include "python/python_result.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "map/exports/csv_tables.h"
#include "map/exports/mapped_trajectory.h"
#include "map/rendering/map_image.h"
#include "map/report/output_folder.h"
#include "python/errors.h"
#include "session/drawn_map.h"

namespace psi_slam {
namespace {

namespace py = pybind11;
using mrpt::maps::COccupancyGridMap2D;

/// Row of Result.poses.
struct PoseRow {
  double time_s;
  double x_m;
  double y_m;
  double yaw_rad;
  double odom_x_m;
  double odom_y_m;
  double odom_yaw_rad;
  double response;
  double psi;
  std::int64_t node;
  std::int64_t run;
  bool matched;
};

/// The class psi_slam.GridMap.
struct PythonGridMap {
  py::object occupancy;
  py::object occupied;
  py::object free;
  double resolution_m = 0;
  double x_min_m = 0;
  double x_max_m = 0;
  double y_min_m = 0;
  double y_max_m = 0;
};

template <class Array>
py::object read_only(Array array) {
  array.attr("flags").attr("writeable") = false;
  return py::object(std::move(array));
}

py::object pose_array(const std::vector<PoseRow>& rows) {
  py::array_t<PoseRow> array(static_cast<py::ssize_t>(rows.size()));
  std::copy(rows.begin(), rows.end(), array.mutable_data());
  return read_only(std::move(array));
}

std::vector<PoseRow> pose_rows(const MappingResult& result) {
  const std::vector<FrameSpan> logs = logs_of(result);
  std::vector<PoseRow> rows;
  rows.reserve(result.frames.size());
  std::size_t log = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    while (log + 1 < logs.size() && logs[log + 1].begin <= i) ++log;
    rows.push_back({seconds(frame.time_us), frame.map_T_robot.x, frame.map_T_robot.y, frame.map_T_robot.phi,
                    frame.odom_T_robot.x, frame.odom_T_robot.y, frame.odom_T_robot.phi, frame.response,
                    frame.psi, frame.node ? static_cast<std::int64_t>(*frame.node) : -1,
                    static_cast<std::int64_t>(log + 1), frame.match == ScanMatch::kMatched});
  }
  return rows;
}

/// Type of text columns that hold texts of up to `length` characters.
std::string text_type(std::size_t length) {
  return "U" + std::to_string(std::max<std::size_t>(length, 1));
}

py::object loop_array(const std::vector<LoopRecord>& loops) {
  py::list rows;
  std::size_t longest = 0;
  for (const LoopRecord& loop : loops) {
    const std::string reason = text_of(loop.rejection);
    longest = std::max(longest, reason.size());
    const auto sigma = [&](int i) { return std::sqrt(loop.covariance(i, i)); };
    const py::tuple numbers = py::make_tuple(loop.frame, loop.node, loop.local_map, loop.anchor);
    const py::tuple texts =
        py::make_tuple(state_text(loop.state), reason, name(loop.matcher), name(loop.search));
    rows.append(numbers + texts +
                py::make_tuple(loop.in_final_search, loop.by_hand, loop.anchor_T_node.x, loop.anchor_T_node.y,
                               loop.anchor_T_node.phi, sigma(0), sigma(1), sigma(2), loop.response,
                               loop.ambiguity, loop.observed_share, loop.neighbours_agree, loop.reverse_agree,
                               loop.moved_m, loop.evaluations));
  }
  py::list fields;
  const auto add = [&](const char* type, std::initializer_list<const char*> names) {
    for (const char* field : names) fields.append(py::make_tuple(field, type));
  };
  add("i8", {"frame", "node", "local_map", "anchor"});
  add("U9", {"state"});
  add(text_type(longest).c_str(), {"reason"});
  add("U16", {"matcher", "search"});
  add("?", {"in_final_search", "by_hand"});
  add("f8", {"x_m", "y_m", "yaw_rad", "sigma_x_m", "sigma_y_m", "sigma_yaw_rad", "response", "ambiguity",
             "observed_share", "neighbours_agree", "reverse_agree", "moved_m"});
  add("i8", {"evaluations"});
  return read_only(py::module_::import("numpy").attr("array")(rows, fields).cast<py::array>());
}

/// Returns an array with a value for each cell; row 0 has the least y.
template <class T, class ValueOf>
py::object cell_array(const COccupancyGridMap2D& grid, const ValueOf& value_of) {
  const std::size_t width = grid.getSizeX();
  const std::size_t height = grid.getSizeY();
  py::array_t<T> array({height, width});
  T* to = array.mutable_data();
  for (std::size_t y = 0; y < height; ++y) {
    const auto* row = grid.getRow(static_cast<int>(y));
    to = std::transform(row, row + width, to, value_of);
  }
  return read_only(std::move(array));
}

PythonGridMap python_grid_map(const COccupancyGridMap2D& grid) {
  using Cell = COccupancyGridMap2D::cellType;
  PythonGridMap map;
  map.occupancy = cell_array<float>(grid, [](Cell cell) { return 1 - COccupancyGridMap2D::l2p(cell); });
  map.occupied = cell_array<bool>(grid, is_occupied);
  map.free = cell_array<bool>(grid, is_free);
  // MRPT stores lengths as floats. These are the doubles that map.yaml states.
  const auto metres = [](float length) {
    return parse_number(trimmed_text(static_cast<double>(length), 4)).value();
  };
  map.resolution_m = parse_number(shortest_text(grid.getResolution())).value();
  map.x_min_m = metres(grid.getXMin());
  map.x_max_m = metres(grid.getXMax());
  map.y_min_m = metres(grid.getYMin());
  map.y_max_m = metres(grid.getYMax());
  return map;
}

}  // namespace

template <class Make>
py::object PythonResult::once(const char* name, const Make& make) {
  if (!made_.contains(name)) made_[name] = make();
  return made_[name];
}

py::object PythonResult::poses() {
  return once("poses", [&] {
    return pose_array(session_->use([](const std::unique_ptr<MappingSession>& session) {
      std::vector<PoseRow> rows;
      session->read_exported([&](const MappingResult& result) { rows = pose_rows(result); });
      return rows;
    }));
  });
}

py::object PythonResult::covariances() {
  return once("covariances", [&] {
    const auto covariances = session_->use([](const std::unique_ptr<MappingSession>& session) {
      std::vector<std::optional<Eigen::Matrix3d>> found;
      session->read_exported([&](const MappingResult& result) { found = frame_covariances(result); });
      return found;
    });
    py::array_t<double> array({static_cast<py::ssize_t>(covariances.size()), py::ssize_t{3}, py::ssize_t{3}});
    double* to = array.mutable_data();
    for (const auto& covariance : covariances)
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
          *to++ = covariance ? (*covariance)(row, column) : std::numeric_limits<double>::quiet_NaN();
    return read_only(std::move(array));
  });
}

py::object PythonResult::loops() {
  return once("loops", [&] {
    return loop_array(session_->use(
        [](const std::unique_ptr<MappingSession>& session) { return session->result().loops; }));
  });
}

/// Draws and judges the map, and keeps what follows from it.
void PythonResult::draw() {
  auto [drawn, json] = session_->use([](const std::unique_ptr<MappingSession>& session) {
    DrawnMap map = session->draw();
    std::string text = summary_json(session->result(), session->run_info(), map.summary);
    return std::pair(std::move(map), std::move(text));
  });
  made_["grid_map"] = python_grid_map(*drawn.grid);
  made_["verdict"] = drawn.summary.verdict.value();
  made_["summary"] = py::module_::import("json").attr("loads")(py::str(json));
}

py::object PythonResult::grid_map() {
  if (!made_.contains("grid_map")) draw();
  return made_["grid_map"];
}

py::object PythonResult::verdict() {
  if (!made_.contains("verdict")) draw();
  return made_["verdict"];
}

py::object PythonResult::summary() {
  if (!made_.contains("summary")) draw();
  return made_["summary"];
}

py::object PythonResult::settings() {
  return once("settings", [&] {
    py::dict settings;
    const RunInfo info =
        session_->use([](const std::unique_ptr<MappingSession>& session) { return session->run_info(); });
    for (const auto& [name, value] : info.settings) settings[py::str(name)] = python_text(value);
    return settings;
  });
}

py::list PythonResult::warnings() {
  if (!made_.contains("summary")) draw();  // warnings about edits and walls follow from the drawn map
  std::vector<std::string> warnings = session_->settings_warnings();
  for (std::string& warning :
       session_->use([](const std::unique_ptr<MappingSession>& session) { return session->warnings(); }))
    warnings.push_back(std::move(warning));
  return python_texts(warnings);
}

bool PythonResult::interrupted() {
  return session_->use(
      [](const std::unique_ptr<MappingSession>& session) { return session->result().interrupted; });
}

py::object PythonResult::broken_off() {
  const auto sentence =
      session_->use([](const std::unique_ptr<MappingSession>& session) { return session->broken_off(); });
  return sentence ? py::object(python_text(*sentence)) : py::none();
}

void PythonResult::save(const std::filesystem::path& folder, bool force) {
  session_->use([&](const std::unique_ptr<MappingSession>& session) {
    session->export_to(OutputFolder::prepare(folder, force, "force=True"));
  });
}

Trajectory PythonResult::trajectory() {
  return session_->use([](const std::unique_ptr<MappingSession>& session) {
    Trajectory trajectory;
    session->read_exported([&](const MappingResult& result) { trajectory = trajectory_of(result.frames); });
    return trajectory;
  });
}

std::string PythonResult::repr() {
  return session_->use([](const std::unique_ptr<MappingSession>& session) {
    const std::vector<LoopRecord>& loops = session->result().loops;
    const auto accepted =
        static_cast<std::size_t>(std::count_if(loops.begin(), loops.end(), [](const LoopRecord& loop) {
          return loop.state == LoopState::kAccepted;
        }));
    return "<psi_slam.Result: " + counted(session->result().frames.size(), "scan") + ", " +
           counted(accepted, "loop") + " closed>";
  });
}

void bind_result(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PoseRow, time_s, x_m, y_m, yaw_rad, odom_x_m, odom_y_m, odom_yaw_rad, response, psi,
                       node, run, matched);

  py::class_<PythonGridMap>(
      module, "GridMap",
      "The map as a grid of square cells. Arrays have the shape (rows, columns). Row 0 has the least y, so\n"
      "show them with matplotlib's imshow(..., origin=\"lower\", extent=grid_map.extent).")
      .def_readonly("occupancy", &PythonGridMap::occupancy,
                    "Probability that a cell is occupied, float32; 0.5 for cells never observed.")
      .def_readonly("occupied", &PythonGridMap::occupied,
                    "Whether a cell is occupied, bool: the black pixels of map.pgm.")
      .def_readonly("free", &PythonGridMap::free,
                    "Whether a cell is free, bool: the white pixels of map.pgm.")
      .def_readonly("resolution_m", &PythonGridMap::resolution_m, "Side of a cell, metres.")
      .def_property_readonly(
          "origin", [](const PythonGridMap& map) { return py::make_tuple(map.x_min_m, map.y_min_m); },
          "Corner (x, y) of the grid with the least coordinates, metres in the frame of the map.")
      .def_property_readonly(
          "extent",
          [](const PythonGridMap& map) {
            return py::make_tuple(map.x_min_m, map.x_max_m, map.y_min_m, map.y_max_m);
          },
          "(x_min, x_max, y_min, y_max) of the grid, metres: the argument `extent` of imshow().")
      .def("__repr__", [](const PythonGridMap& map) {
        const py::tuple shape = map.occupancy.attr("shape");
        return "<psi_slam.GridMap: " + std::string(py::str(shape[0])) + " rows, " +
               std::string(py::str(shape[1])) + " columns, cells of " + trimmed_text(map.resolution_m, 6) +
               " m>";
      });

  py::class_<HotSpot>(module, "HotSpot", "A doubtful place of the map.")
      .def_property_readonly(
          "kind", [](const HotSpot& spot) { return text_of(spot.kind); },
          "Kind of fault: \"doubled wall\", ...")
      .def_property_readonly(
          "x_m", [](const HotSpot& spot) { return spot.at.x; }, "Place in the map, metres.")
      .def_property_readonly(
          "y_m", [](const HotSpot& spot) { return spot.at.y; }, "Place in the map, metres.")
      .def_readonly("error_m", &HotSpot::error_m, "Estimated error, metres; None for a run without a place.")
      .def_readonly("length_m", &HotSpot::length_m,
                    "Length of the path along which the fault is seen, metres.")
      .def_property_readonly(
          "suspect", [](const HotSpot& spot) { return text_of(spot.suspect); },
          "Probable cause: a loop, or a stretch of the path.")
      .def_property_readonly("advice", &advice_text, "The edit or the drive that would help.")
      .def_property_readonly("edit", &edit_line,
                             "Line for a file of edits that would help; empty if no edit is advised.")
      .def_property_readonly(
          "moved_m",
          [](const HotSpot& spot) {
            return spot.effect ? std::optional<double>(spot.effect->moved_m) : std::nullopt;
          },
          "Largest motion of a node by that edit, metres; None without an edit.")
      .def("__repr__", [](const HotSpot& spot) { return "<psi_slam.HotSpot: " + hot_spot_text(spot) + ">"; });

  const auto place = [](const mrpt::math::TPoint2D& at) { return py::make_tuple(at.x, at.y); };
  py::class_<UncheckedStretch>(module, "UncheckedStretch", "Part of the path that no second pass checks.")
      .def_readonly("first_scan", &UncheckedStretch::first_frame, "Number of its first scan.")
      .def_readonly("last_scan", &UncheckedStretch::last_frame, "Number of its last scan.")
      .def_readonly("length_m", &UncheckedStretch::length_m, "Length of this part of the path, metres.")
      .def_property_readonly(
          "first_place", [=](const UncheckedStretch& stretch) { return place(stretch.first_at); },
          "Place (x, y) of its first scan in the map, metres.")
      .def_property_readonly(
          "last_place", [=](const UncheckedStretch& stretch) { return place(stretch.last_at); },
          "Place (x, y) of its last scan in the map, metres.")
      .def_readonly("sigma_m", &UncheckedStretch::sigma_m,
                    "Largest standard deviation of the position, metres; None if it is unknown.");

  py::class_<OpenStretch>(module, "OpenStretch",
                          "Part of the path along walls that leave the position along them open.")
      .def_readonly("first_scan", &OpenStretch::first_frame, "Number of its first scan.")
      .def_readonly("last_scan", &OpenStretch::last_frame, "Number of its last scan.")
      .def_readonly("length_m", &OpenStretch::length_m, "Motion along the walls, metres.")
      .def_property_readonly(
          "place", [=](const OpenStretch& stretch) { return place(stretch.at); },
          "Place (x, y) of its middle in the map, metres.")
      .def_readonly("has_odometry", &OpenStretch::has_odometry, "Whether odometry measured the motion.");

  py::class_<SceneChange>(module, "SceneChange", "Place where the building changed between two passes.")
      .def_property_readonly(
          "place", [=](const SceneChange& change) { return place(change.at); },
          "Place (x, y) in the map, metres.")
      .def_readonly("before_s", &SceneChange::before_s,
                    "Time of the last scan that saw it before, seconds since the first scan.")
      .def_readonly("after_s", &SceneChange::after_s,
                    "Time of the first scan that saw it afterwards, seconds since the first scan.");

  py::class_<MapVerdict>(module, "Verdict", "Judgement of a map without ground truth.")
      .def_property_readonly(
          "state", [](const MapVerdict& verdict) { return text_of(verdict.state); },
          "\"good\", \"unchecked\", \"check these places\" or \"broken\".")
      .def_property_readonly("sentence", &verdict_sentence, "The verdict in one sentence.")
      .def_readonly("error_m", &MapVerdict::error_m, "Estimated mean error from what the scans show, metres.")
      .def_readonly("predicted_m", &MapVerdict::predicted_m,
                    "Mean standard deviation of positions that the graph predicts, metres.")
      .def_property_readonly("doubt_m", &MapVerdict::doubt_m,
                             "error_m + predicted_m: ranks maps of one log, metres.")
      .def_readonly("wall_thickness_m", &MapVerdict::wall_thickness_m,
                    "90th percentile of the distances between the walls of two passes, metres.")
      .def_readonly("checked_share", &MapVerdict::checked_share,
                    "Share of the path that several passes saw, in [0, 1].")
      .def_readonly("held_share", &MapVerdict::held_share,
                    "Share of the path between places where passes fit, in [0, 1].")
      .def_readonly("unchecked_stretches", &MapVerdict::unchecked_stretches,
                    "Parts of the path that no second pass checks, the most uncertain first: a list of\n"
                    "UncheckedStretch.")
      .def_readonly("open_stretches", &MapVerdict::open_stretches,
                    "Parts of the path along bare walls, in the order of the log: a list of OpenStretch.")
      .def_readonly("changes", &MapVerdict::changes,
                    "Places where the building changed between passes: a list of SceneChange.")
      .def_readonly("hot_spots", &MapVerdict::hot_spots,
                    "Doubtful places, the worst first: a list of HotSpot.")
      .def_readonly("more_hot_spots", &MapVerdict::more_hot_spots,
                    "Number of doubtful places beyond those of hot_spots.")
      .def("__repr__",
           [](const MapVerdict& verdict) { return "<psi_slam.Verdict: " + verdict_sentence(verdict) + ">"; });

  py::class_<PythonResult>(module, "Result",
                           "A finished map. Each property is computed when it is first read; its arrays are\n"
                           "read-only. Poses are in the frame of the exported map.")
      .def_property_readonly(
          "poses", &PythonResult::poses,
          "Poses of the robot, one row for each scan: a structured array with the fields time_s, x_m, y_m,\n"
          "yaw_rad; odom_x_m, odom_y_m, odom_yaw_rad (pose by odometry); response (of the match, in [0, "
          "1]);\n"
          "psi (the factor Psi); node (number in the pose graph, -1 if the scan is no node); run (number of\n"
          "the log, from 1); matched (False: the pose is a prediction, or the scan is the first of a run).")
      .def_property_readonly(
          "covariances", &PythonResult::covariances,
          "Covariances of (x, y, yaw) of the poses in the axes of the map, relative to the first scan: an\n"
          "array of the shape (scans, 3, 3) in m^2, m rad and rad^2. NaN where the place is unknown.")
      .def_property_readonly(
          "loops", &PythonResult::loops,
          "Attempts to close loops: a structured array with the columns of loops.csv. (x_m, y_m, yaw_rad) "
          "is\n"
          "the matched pose of the node in the frame of the anchor, sigma_* its standard deviations. "
          "state\n"
          "is \"candidate\", \"accepted\" or \"rejected\"; reason says why a loop was rejected.")
      .def_property_readonly("grid_map", &PythonResult::grid_map, "The drawn map with its edits: a GridMap.")
      .def_property_readonly("verdict", &PythonResult::verdict,
                             "Whether the map is good, judged without ground truth: a Verdict.")
      .def_property_readonly("summary", &PythonResult::summary, "The content of summary.json, as a dict.")
      .def_property_readonly("settings", &PythonResult::settings,
                             "Value of each setting by its name, as texts of a settings file.")
      .def_property_readonly("warnings", &PythonResult::warnings,
                             "Warnings about settings, log and map, one sentence each.")
      .def_property_readonly(
          "interrupted", &PythonResult::interrupted,
          "Whether readable scans of the log were left unread, or the final loop search was cut short.")
      .def_property_readonly("broken_off", &PythonResult::broken_off,
                             "Damage of the log after its last readable scan, as a sentence, or None.")
      .def("save", &PythonResult::save, py::arg("folder"), py::arg("force") = false,
           "Writes every file that psi-slam writes, with the same bytes except for measured times.\n\n"
           "Creates the folder. Raises UserError if it is not empty, unless `force` is True; then the files\n"
           "of a run are replaced. Raises SystemFailure if a file cannot be written.")
      .def("__repr__", &PythonResult::repr);
}

}  // namespace psi_slam
