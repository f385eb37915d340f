// SPDX-License-Identifier: BSD-3-Clause
#include "common/search_shares.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "base/number_text.h"

namespace psi_slam {

ReportCell searches_cell(const std::array<std::size_t, kSearchKinds.size()>& searches) {
  const auto all = static_cast<double>(std::accumulate(searches.begin(), searches.end(), std::size_t{0}));
  std::vector<std::pair<std::size_t, const char*>> ran;
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < searches.size(); ++i) {
    counts[name(kSearchKinds[i])] = searches[i];
    if (searches[i] > 0) ran.emplace_back(searches[i], name(kSearchKinds[i]));
  }
  std::stable_sort(ran.begin(), ran.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [count, search] : ran) {
    text += (text.empty() ? "" : ", ") + std::string(search);
    if (ran.size() > 1) text += ' ' + fixed_text(100 * static_cast<double>(count) / all, 1) + " %";
  }
  return {text.empty() ? "–" : text, counts};
}

}  // namespace psi_slam
