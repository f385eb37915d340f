#include <iostream>
#include <chrono>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include "pose_graph/path_covariance.h"
#include "verdict/faulty_maps.h"
#include "verdict/loop_residuals.h"
#include "verdict/pass_checks.h"
#include "verdict/map_verdict.h"
#include "verdict/path_suspects.h"
using namespace psi_slam;
using Json = nlohmann::json;
double r3(double v) { return std::round(v * 1e3) / 1e3; }
int main(int, char** argv) {
  const int a = std::stoi(argv[1]), b = std::stoi(argv[2]);
  for (int seed = a; seed <= b; ++seed)
    make_faulty_maps(static_cast<std::uint64_t>(seed), [&](FaultyMap&& map) {
      const MappingResult& r = map.result;
      const double t0 = static_cast<double>(std::clock());
      const auto views = map_views(r);
      const double t1 = static_cast<double>(std::clock());
      const auto checks = check_passes(views);
      const double t2 = static_cast<double>(std::clock());
      const auto residuals = loop_residuals(r);
      const auto suspects = path_suspects(r);
      PathCovarianceSearch search;
      search.run(r.graph, r.graph.root());
      const double t3 = static_cast<double>(std::clock());
      Json j = {{"fault", name_of(map.fault)}, {"seed", seed}, {"error", map.error_m}, {"frames", r.frames.size()},
                {"nodes", r.node_frames.size()}, {"views_ms", (t1 - t0) / 1e3}, {"checks_ms", (t2 - t1) / 1e3},
                {"rest_ms", (t3 - t2) / 1e3}, {"wall", r.wall_s}, {"stages", Json::array()}};
      double total = 0;
      for (const auto& s : r.stages) total += s.total_s;
      j["stage_s"] = total;
      for (const auto& p : map.places) j["places"].push_back({r3(p.x), r3(p.y)});
      for (const auto& v : views)
        j["views"].push_back({v.node, v.frame, r3(v.travelled_m), r3(v.map_T_robot.x), r3(v.map_T_robot.y),
                              search.of(v.node).reached ? r3(search.of(v.node).position_sigma_m()) : -1.0, v.surfaces.points.size()});
      for (const auto& c : checks)
        j["checks"].push_back({c.view, c.other, c.same_pass, c.scans.points, c.scans.same, c.scans.seen_through, r3(c.scans.offset_m),
                               r3(c.scans.displacement_m), r3(c.scans.turn_rad), r3(c.scans.same_if_moved), r3(c.scans.at.x), r3(c.scans.at.y), r3(c.error_m)});
      for (std::size_t i = 0; i < std::min<std::size_t>(residuals.size(), 12); ++i) {
        const auto& l = r.loops[residuals[i].loop];
        j["loops"].push_back({residuals[i].loop, r3(residuals[i].residual_m), r3(residuals[i].residual_rad), r3(residuals[i].chi), l.anchor, l.node,
             residuals[i].loop});
      }
      j["nloops"] = residuals.size();
      j["all_loops"] = r.loops.size();
      for (const auto& s : suspects) j["suspects"].push_back({static_cast<int>(s.kind), s.first_frame, s.last_frame, r3(s.doubt_m)});
      const MapVerdict verdict = judge_map(r);
      j["state"] = text_of(verdict.state);
      j["verror"] = verdict.error_m;
      j["checked"] = verdict.checked_share;
      for (const HotSpot& s : verdict.hot_spots)
        j["spots"].push_back({text_of(s.kind), r3(s.at.x), r3(s.at.y), r3(s.error_m), r3(s.length_m), text_of(s.suspect), r3(s.suspect.at.x), r3(s.suspect.at.y)});
      for (const auto& i : r.interruptions) j["lost"].push_back({i.frame, i.found_frame ? static_cast<int>(*i.found_frame) : -1});
      std::cout << j.dump() << std::endl;
    });
}
