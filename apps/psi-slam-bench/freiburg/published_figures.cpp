// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

namespace psi_slam {
namespace {

constexpr const char* kAces = "aces";
constexpr const char* kIntel = "intel";
constexpr const char* kKillian = "mit-killian";
constexpr const char* kCsail = "mit-csail";
constexpr const char* kFreiburg = "fr079";
constexpr const char* kHospital = "fr-hospital";

using Figure = PublishedFigure;

PublishedLog all_four(const char* log, Figure translation_m, Figure translation_m2, Figure rotation_deg,
                      Figure rotation_deg2) {
  return {log, {translation_m, translation_m2, rotation_deg, rotation_deg2}};
}

/// Errors of a system whose squared errors, and possibly rotational errors, are unknown.
PublishedLog absolute(const char* log, Figure translation_m, std::optional<Figure> rotation_deg = {}) {
  return {log, {translation_m, std::nullopt, rotation_deg, std::nullopt}};
}

constexpr const char* kPaper = "A self-adaptive loop matching algorithm based on GA for 2D lidar SLAM";

constexpr const char* kKuemmerle =
    "R. Kümmerle, B. Steder, C. Dornhege, M. Ruhnke, G. Grisetti, C. Stachniss and A. Kleiner, On measuring "
    "the accuracy of SLAM algorithms, Autonomous Robots 27(4), 2009";
constexpr const char* kTranslationOnly = "; translation only; its other figures are not quoted here.";

constexpr const char* kHess =
    "W. Hess, D. Kohler, H. Rapp and D. Andor, Real-time loop closure in 2D LIDAR SLAM, ICRA 2016";

constexpr const char* kLive = " measured here on the same files with shipped defaults and every scan.";

}  // namespace

const PublishedErrors* PublishedSystem::errors_of(const std::string& log) const {
  for (const PublishedLog& one : logs)
    if (one.log == log) return &one.errors;
  return nullptr;
}

const std::vector<PublishedSystem>& published_systems() {
  static const std::vector<PublishedSystem> kSystems{
      {"GA-based (paper)",
       std::string(kPaper) + ", tables 1 and 2.",
       {all_four(kAces, {0.238, 0.533}, {0.411, 2.320}, {0.336, 0.829}, {1.056, 4.714}),
        all_four(kIntel, {0.165, 0.470}, {0.306, 1.924}, {1.253, 2.866}, {8.632, 25.707}),
        all_four(kKillian, {0.249, 0.608}, {0.507, 2.692}, {0.357, 1.433}, {1.734, 4.635}),
        all_four(kCsail, {0.226, 0.482}, {0.384, 1.815}, {0.522, 2.054}, {4.732, 12.788}),
        all_four(kFreiburg, {0.328, 0.859}, {0.930, 3.556}, {0.921, 3.714}, {11.408, 33.224}),
        all_four(kHospital, {0.575, 0.836}, {1.255, 3.880}, {1.457, 2.602}, {10.575, 52.016})}},
      {"Karto (paper)",
       std::string(kPaper) + ", table 1.",
       {all_four(kAces, {0.408, 1.325}, {1.604, 7.009}, {0.440, 0.683}, {0.874, 3.295}),
        all_four(kIntel, {0.207, 0.823}, {0.702, 3.204}, {1.875, 3.830}, {16.170, 83.348}),
        all_four(kKillian, {0.350, 0.752}, {0.608, 3.159}, {0.755, 2.514}, {7.548, 22.900})}},
      {"GMapping (paper)",
       std::string(kPaper) + ", table 2.",
       {all_four(kCsail, {0.443, 0.879}, {2.175, 8.033}, {1.216, 3.724}, {14.915, 77.362}),
        all_four(kFreiburg, {0.507, 1.074}, {3.404, 14.538}, {1.030, 2.715}, {8.799, 17.036}),
        all_four(kHospital, {0.873, 2.825}, {8.239, 34.372}, {2.609, 5.330}, {34.152, 142.274})}},
      {"scan matching",
       std::string(kKuemmerle) + kTranslationOnly,
       {absolute(kAces, {0.173, 0.614}), absolute(kIntel, {0.220, 0.296}), absolute(kKillian, {1.651, 4.138}),
        absolute(kCsail, {0.106, 0.325}), absolute(kFreiburg, {0.258, 0.427}),
        absolute(kHospital, {0.434, 1.615})}},
      {"RBPF",
       std::string("50 particles: ") + kKuemmerle + kTranslationOnly,
       {absolute(kAces, {0.060, 0.049}), absolute(kIntel, {0.070, 0.083}), absolute(kKillian, {0.122, 0.386}),
        absolute(kCsail, {0.049, 0.049}), absolute(kFreiburg, {0.061, 0.044}),
        absolute(kHospital, {0.637, 2.638})}},
      {"graph mapping",
       std::string(kKuemmerle) +
           ", as quoted in table II of Hess et al., ICRA 2016; few digits; Freiburg hospital: local "
           "relations. The relations of MIT CSAIL were probably made from the result of "
           "this system.",
       {all_four(kAces, {0.044, 0.044}, {0.004, 0.009}, {0.4, 0.4}, {0.3, 0.8}),
        all_four(kIntel, {0.031, 0.026}, {0.002, 0.004}, {1.3, 4.7}, {24.0, 166.1}),
        all_four(kKillian, {0.050, 0.056}, {0.006, 0.029}, {0.5, 0.5}, {0.9, 0.9}),
        all_four(kCsail, {0.004, 0.009}, {0.0001, 0.0005}, {0.05, 0.08}, {0.01, 0.04}),
        all_four(kFreiburg, {0.056, 0.042}, {0.005, 0.011}, {0.6, 0.6}, {0.7, 1.7}),
        all_four(kHospital, {0.143, 0.180}, {0.053, 0.272}, {0.9, 2.2}, {5.5, 46.2})}},
      {"graph FLIRT",
       std::string(
           "G. D. Tipaldi, M. Braun and K. O. Arras, FLIRT: Interest regions for 2D range data with "
           "applications to robot navigation, Experimental Robotics, 2014, as quoted in table III of "
           "Hess et al., ICRA 2016; few digits, no squared errors; Freiburg hospital: local relations."),
       {absolute(kIntel, {0.02, 0.02}, Figure{0.3, 0.3}), absolute(kFreiburg, {0.06, 0.09}, Figure{0.8, 1.1}),
        absolute(kHospital, {0.18, 0.27}, Figure{0.9, 2.0})}},
      {"Cartographer",
       std::string(kHess) + ", table II; Freiburg hospital: local relations.",
       {all_four(kAces, {0.0375, 0.0426}, {0.0032, 0.0285}, {0.373, 0.469}, {0.359, 3.696}),
        all_four(kIntel, {0.0229, 0.0239}, {0.0011, 0.0040}, {0.453, 1.335}, {1.986, 23.988}),
        all_four(kKillian, {0.0395, 0.0488}, {0.0039, 0.0144}, {0.352, 0.353}, {0.248, 0.610}),
        all_four(kCsail, {0.0319, 0.0363}, {0.0023, 0.0099}, {0.369, 0.365}, {0.270, 0.637}),
        all_four(kFreiburg, {0.0452, 0.0354}, {0.0033, 0.0055}, {0.538, 0.718}, {0.804, 3.627}),
        all_four(kHospital, {0.1078, 0.1943}, {0.0494, 0.2831}, {0.747, 2.047}, {4.745, 40.081})}},
      {"Cartographer (its paths)",
       "Cartographer trajectories published by others, measured here with the same relations; the "
       "standard deviations were not kept.",
       {absolute(kIntel, {0.0224, {}}, Figure{0.388, {}}), absolute(kCsail, {0.0364, {}}, Figure{0.331, {}}),
        absolute(kFreiburg, {0.0441, {}}, Figure{0.517, {}})}},
      {"Karto (live)",
       std::string("open_karto with sparse pose adjustment,") + kLive +
           " It failed to map Freiburg 079, where odometry has the wrong sign when the robot reverses "
           "(0.0563 ± 0.0388 m with corrected signs). It missed the loops of MIT Killian.",
       {absolute(kAces, {0.0492, 0.0424}, Figure{0.708, {}}),
        absolute(kIntel, {0.0213, 0.0144}, Figure{0.722, {}}),
        absolute(kKillian, {1.09, 2.85}, Figure{1.181, {}}),
        absolute(kCsail, {0.0407, 0.0403}, Figure{1.075, {}}),
        absolute(kFreiburg, {2.89, 6.31}, Figure{7.64, {}})}},
      {"slam_toolbox (live)",
       std::string("slam_toolbox,") + kLive +
           " Its map of Intel has double walls, and its map of MIT Killian has false loops.",
       {absolute(kAces, {0.0539, 0.0734}, Figure{1.031, {}}),
        absolute(kIntel, {0.3095, 1.0193}, Figure{1.498, {}}),
        absolute(kKillian, {0.522, 2.505}, Figure{1.358, {}}),
        absolute(kCsail, {0.0579, 0.0730}, Figure{2.749, {}}),
        absolute(kFreiburg, {0.566, 1.168}, Figure{4.45, {}})}},
      {"GMapping (live)",
       std::string("30 particles,") + kLive,
       {absolute(kAces, {0.0490, 0.0461}, Figure{1.071, {}}),
        absolute(kIntel, {0.0394, 0.0347}, Figure{1.904, {}}),
        absolute(kCsail, {0.0550, 0.0584}, Figure{3.382, {}})}}};
  return kSystems;
}

const std::vector<BenchmarkLogTitle>& benchmark_log_titles() {
  static const std::vector<BenchmarkLogTitle> kTitles{
      {kAces, "ACES"},       {kIntel, "Intel"},           {kKillian, "MIT Killian"},
      {kCsail, "MIT CSAIL"}, {kFreiburg, "Freiburg 079"}, {kHospital, "Freiburg hospital"}};
  return kTitles;
}

std::string benchmark_log_name(const std::string& name) {
  return name == "hospital" ? kHospital : name;
}

std::string benchmark_log_title(const std::string& name) {
  for (const BenchmarkLogTitle& title : benchmark_log_titles())
    if (title.log == benchmark_log_name(name)) return title.title;
  return name;
}

}  // namespace psi_slam
