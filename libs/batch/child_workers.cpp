// SPDX-License-Identifier: BSD-3-Clause
#include "batch/child_workers.h"

#include "batch/cbor_text.h"
#include "batch/make_at_a_time.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Json = nlohmann::json;

}  // namespace

std::optional<ChildEnd> run_to_end(const ChildWords& words, const std::function<bool()>& stop) {
  try {
    ChildEnd end = run_child({words, 0, stop});
    if (end.stopped && end.code != 0) return std::nullopt;
    return end;
  } catch (const SystemFailure& failure) {
    ChildEnd end;
    end.err = failure.what();
    return end;
  }
}

ChildWorkers local_child_workers(int processes) {
  return [processes](const std::vector<ChildWords>& children, const ChildWatch& watch) {
    make_at_a_time(processes, children.size(), watch,
                   [&](std::size_t index, const auto& stop) { return run_to_end(children[index], stop); });
  };
}

std::string child_words_text(const ChildWords& words) {
  return cbor_text(words);
}

ChildWords read_child_words(const std::string& text) {
  return Json::from_cbor(text).get<ChildWords>();
}

std::string child_end_text(const ChildEnd& end) {
  return cbor_text({{"code", end.code},
                    {"signal", end.signal},
                    {"over_time", end.over_time},
                    {"stopped", end.stopped},
                    {"out", end.out},
                    {"err", end.err},
                    {"wall_s", end.wall_s},
                    {"cpu_s", end.cpu_s},
                    {"peak_memory_mib", end.peak_memory_mib}});
}

ChildEnd read_child_end(const std::string& text) {
  const Json json = Json::from_cbor(text);
  ChildEnd end;
  json.at("code").get_to(end.code);
  json.at("signal").get_to(end.signal);
  json.at("over_time").get_to(end.over_time);
  json.at("stopped").get_to(end.stopped);
  json.at("out").get_to(end.out);
  json.at("err").get_to(end.err);
  json.at("wall_s").get_to(end.wall_s);
  json.at("cpu_s").get_to(end.cpu_s);
  json.at("peak_memory_mib").get_to(end.peak_memory_mib);
  return end;
}

}  // namespace psi_slam
