// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace psi_slam {

/// The first few, a line each, and how many more there are: what fits into a bar.
inline std::string first_sentences(const std::vector<std::string>& sentences) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < sentences.size() && i < kMost; ++i) text += (i == 0 ? "" : "\n") + sentences[i];
  if (sentences.size() > kMost) text += "\nand " + std::to_string(sentences.size() - kMost) + " more";
  return text;
}

}  // namespace psi_slam
