// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_benchmark.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/temporary_folder.h"
#include "live_mapping.h"
#include "mapping/carried_frames.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "session/session_input.h"
#include "simulate/forked_work.h"
#include "simulate/simulate_benchmark.h"
#include "sparse/node_costs.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;

/// Restricts the process to the first `count` of its processors.
void use_processors(int count) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) throw SystemFailure("cannot read the processors");
  if (CPU_COUNT(&allowed) < count)
    throw UserError("--processors " + std::to_string(count) + ": this machine gives the program only " +
                    std::to_string(CPU_COUNT(&allowed)) + ". Choose fewer");
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  for (int processor = 0; processor < CPU_SETSIZE && CPU_COUNT(&chosen) < count; ++processor)
    if (CPU_ISSET(processor, &allowed)) CPU_SET(processor, &chosen);
  if (sched_setaffinity(0, sizeof chosen, &chosen) != 0) throw SystemFailure("cannot choose the processors");
}

double ms_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - begin).count();
}

/// Frames in memory, each of which is returned when it is due.
class PacedSource : public FrameSource {
 public:
  /// Frames before `first_paced` are due at once. The others begin at `begin`; `after_begin` returns when
  /// after that a frame is due.
  PacedSource(std::vector<Frame> frames, std::size_t first_paced, std::shared_future<Clock::time_point> begin,
              std::function<Clock::duration(std::size_t)> after_begin)
      : frames_(std::move(frames)),
        first_paced_(first_paced),
        begin_(std::move(begin)),
        after_begin_(std::move(after_begin)) {}

  std::optional<Frame> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    if (next_ >= first_paced_) std::this_thread::sleep_until(begin_.get() + after_begin_(next_));
    return std::move(frames_[next_++]);
  }
  double progress() const override { return 0; }

 private:
  std::vector<Frame> frames_;
  std::size_t first_paced_;
  std::shared_future<Clock::time_point> begin_;
  std::function<Clock::duration(std::size_t)> after_begin_;
  std::size_t next_ = 0;
};

/// A replay to make: a log, or a simulated run.
struct Task {
  std::string name;
  Settings settings;
  std::function<std::vector<Frame>()> read;
  std::vector<Relation> relations;
};

std::vector<Frame> frames_of(FrameSource& source, double stretch_s) {
  std::vector<Frame> frames;
  while (std::optional<Frame> frame = source.next()) {
    if (stretch_s > 0 && !frames.empty() && seconds(frame->time_us - frames.front().time_us) > stretch_s)
      break;
    frames.push_back(*std::move(frame));
  }
  return frames;
}

Task task_of_log(const BenchmarkLog& log, const LiveBenchmarkOptions& options) {
  Task task;
  task.name = log.name;
  task.settings = benchmark_settings(log.ini, options.assignments);
  task.read = [path = log.log, reading = log_options(task.settings), stretch_s = options.stretch_s] {
    return frames_of(*open_log(path, reading), stretch_s);
  };
  if (options.stretch_s == 0) task.relations = read_relations(log.relations.value());
  return task;
}

Task simulated_task(double path_m, const LiveBenchmarkOptions& options) {
  constexpr std::uint64_t kSeed = 1;
  SimulateOptions simulate;
  simulate.seed = kSeed;
  const SimulatedLogOptions run = simulated_run_options(simulate, path_m);
  Task task;
  task.name = "simulated " + metres_text(path_m);
  task.settings = benchmark_settings({}, options.assignments);
  SimulatedLog log(run);
  Trajectory truth;
  while (const std::optional<Frame> frame = log.next())
    truth.push_back({frame->time_us, log.world_T_robot()});
  task.relations = draw_relations(truth, kRelations, kSeed);
  task.read = [run] {
    SimulatedLog again(run);
    return frames_of(again, 0);
  };
  return task;
}

LiveRow row_of(const Task& task, double speed, int processors, double timed_s,
               const std::function<void(double)>& progress) {
  use_processors(processors);
  Replayed replayed = replay(task.read(), task.settings, speed, progress, timed_s);
  LiveRow row;
  row.log = task.name;
  row.speed = speed;
  row.processors = processors;
  row.scans = replayed.result.frames.size();
  row.timed_scans = replayed.latency_ms.size();
  row.nodes = replayed.result.node_frames.size();
  row.mean_ms = summary_of_times(replayed.latency_ms).mean;
  row.p50_ms = quantile(replayed.latency_ms, 0.5);
  row.p99_ms = quantile(replayed.latency_ms, 0.99);
  row.max_ms = quantile(std::move(replayed.latency_ms), 1);
  row.missed_deadlines = replayed.missed_deadlines;
  row.cpu_ms = 1e3 * replayed.cpu_s / static_cast<double>(std::max<std::size_t>(1, row.timed_scans));
  if (task.relations.empty()) return row;
  row.live_m = error_of(replayed.live, task.relations).translation_abs_m.mean;
  row.mapped_m = error_of(replayed.mapped, task.relations).translation_abs_m.mean;
  row.final_m = error_of(replayed.result.frames, task.relations).translation_abs_m.mean;
  return row;
}

/// Index of the first frame in the last `seconds` of the frames; 0: the first frame.
std::size_t first_of_last_seconds(const std::vector<double>& due_s, double seconds) {
  if (due_s.empty() || seconds == 0) return 0;
  const auto first = std::lower_bound(due_s.begin(), due_s.end(), due_s.back() - seconds);
  return static_cast<std::size_t>(first - due_s.begin());
}

std::string text_of(const LiveRow& row) {
  nlohmann::json json{{"mean", row.mean_ms}, {"p50", row.p50_ms},
                      {"p99", row.p99_ms},   {"max", row.max_ms},
                      {"scans", row.scans},  {"timed", row.timed_scans},
                      {"nodes", row.nodes},  {"missed", row.missed_deadlines},
                      {"cpu", row.cpu_ms}};
  if (row.live_m) json["live"] = *row.live_m;
  if (row.mapped_m) json["mapped"] = *row.mapped_m;
  if (row.final_m) json["final"] = *row.final_m;
  return json.dump();
}

LiveRow row_of_text(const std::string& text, const Task& task, double speed, int processors) {
  const nlohmann::json json = nlohmann::json::parse(text);
  LiveRow row{task.name,         speed,           processors,     json.at("scans"), json.at("timed"),
              json.at("nodes"),  json.at("mean"), json.at("p50"), json.at("p99"),   json.at("max"),
              json.at("missed"), json.at("cpu"),  std::nullopt,   std::nullopt,     std::nullopt};
  if (json.contains("live")) row.live_m = json["live"].get<double>();
  if (json.contains("mapped")) row.mapped_m = json["mapped"].get<double>();
  if (json.contains("final")) row.final_m = json["final"].get<double>();
  return row;
}

}  // namespace

std::vector<double> due_times_s(const std::vector<Frame>& frames, double longest_pause_s) {
  std::vector<double> due_s;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double pause_s = i == 0 ? 0 : seconds(frames[i].time_us - frames[i - 1].time_us);
    due_s.push_back((i == 0 ? 0 : due_s.back()) + std::clamp(pause_s, 0.0, longest_pause_s));
  }
  return due_s;
}

Replayed replay(std::vector<Frame> frames, const Settings& settings, double speed,
                const std::function<void(double)>& progress, double timed_s) {
  if (frames.empty()) throw UserError("the log has no scan to replay");
  const TemporaryFolder folder;
  const std::vector<double> due_s = due_times_s(frames);
  const std::size_t first_timed = first_of_last_seconds(due_s, timed_s);
  const auto after_begin = [&](std::size_t scan) {
    const double time_s = speed > 0 ? (due_s[scan] - due_s[first_timed]) / speed : 0;
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
  };
  std::promise<Clock::time_point> promise;
  MappingSession session(SessionInput("replay",
                                      [&, begin = promise.get_future().share()](const LogOptions&) {
                                        return std::make_unique<PacedSource>(std::move(frames), first_timed,
                                                                             begin, after_begin);
                                      }),
                         settings);
  std::promise<Clock::time_point> begins = std::move(promise);  // an exception lets the source end first
  LiveMapping mapping(session, folder.path(), settings,
                      [](const std::string& sentence) { throw SystemFailure(sentence); });
  Replayed replayed;
  std::clock_t cpu_before = 0;
  std::size_t missed_before = 0;
  const Mapper& mapper = session.mapper();
  Clock::time_point first;
  Clock::time_point step_begin;
  session.set_pose_observer([&](const FrameRecord& record) {
    replayed.live.push_back(record);
    const std::size_t scan = mapper.frames().size() - 1;
    if (scan < first_timed) return;
    replayed.latency_ms.push_back(
        ms_between(speed > 0 ? first + after_begin(scan) : step_begin, Clock::now()));
  });
  do {
    if (mapper.frames().size() == first_timed) {
      mapping.catch_up();
      cpu_before = std::clock();
      missed_before = mapper.missed_deadlines();
      first = Clock::now();
      begins.set_value(first);
    }
    progress(static_cast<double>(mapper.frames().size()) / static_cast<double>(due_s.size()));
    step_begin = Clock::now();
  } while (mapping.step());
  mapper.wait();
  replayed.cpu_s = static_cast<double>(std::clock() - cpu_before) / CLOCKS_PER_SEC;
  replayed.missed_deadlines = mapper.missed_deadlines() - missed_before;
  replayed.mapped = mapper.frames();
  std::vector<std::size_t> node_frames;
  for (const NodeScan& node : mapper.keyframes().nodes) node_frames.push_back(node.frame);
  carry_frames_along(mapper.graph().poses(), node_frames, replayed.mapped, mapper.later_run_frames());
  session.finish();
  replayed.result = session.result();
  return replayed;
}

LiveBenchmark run_live_benchmark(const SparseLogs& logs, const LiveBenchmarkOptions& options,
                                 const ProgressObserver& observer) {
  LiveBenchmark benchmark;
  std::vector<Task> tasks;
  for (const auto* some : {&logs.dense, &logs.sparse}) {
    for (LogIdentity& identity : identities_of(*some)) benchmark.identities.push_back(std::move(identity));
    for (const BenchmarkLog& log : *some) tasks.push_back(task_of_log(log, options));
  }
  for (const double path_m : options.simulated_m) tasks.push_back(simulated_task(path_m, options));
  const auto all = static_cast<double>(tasks.size() * options.speeds.size() * options.processors.size());
  for (const Task& task : tasks)
    for (const double speed : options.speeds)
      for (const int processors : options.processors) {
        const auto done = static_cast<double>(benchmark.rows.size());
        const auto report_share = [&](const std::string& percent) {
          observer(task.name, done + std::stoi(percent) / 100.0, all);
        };
        const std::string row = run_forked(
            [&](const TextObserver& report) {
              int reported = -1;
              return text_of(row_of(task, speed, processors, options.timed_s, [&](double share) {
                const int percent = static_cast<int>(99 * share);
                if (percent != std::exchange(reported, percent)) report(std::to_string(percent));
              }));
            },
            report_share);
        benchmark.rows.push_back(row_of_text(row, task, speed, processors));
      }
  benchmark.without_relations = logs.without_relations;
  return benchmark;
}

}  // namespace psi_slam
