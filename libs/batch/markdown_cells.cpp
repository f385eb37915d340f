// SPDX-License-Identifier: BSD-3-Clause
#include "batch/markdown_cells.h"

#include <algorithm>

#include "base/number_text.h"

namespace psi_slam {

std::string errors_text(const MeanAndStd& errors) {
  return fixed_text(errors.mean, 4) + " ± " + fixed_text(errors.std, 4);
}

std::string cell_text(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

std::string path_figure_heads() {
  std::string text;
  for (const PathFigure& figure : kPathFigures) text += ' ' + std::string(figure.name) + " |";
  return text;
}

}  // namespace psi_slam
