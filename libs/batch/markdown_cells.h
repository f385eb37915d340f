// SPDX-License-Identifier: BSD-3-Clause
// What the cells of the Markdown pages are put together from.
#pragma once

#include <string>

#include "batch/run_figures.h"

namespace psi_slam {

/// "0.0200 ± 0.0150".
std::string errors_text(const MeanAndStd& errors);

/// Whole sentences are told by what fits a table's cell: in one line, without bars.
std::string cell_text(std::string text);

std::string repeated(const std::string& text, std::size_t times);

/// " translation [m] | ... |": the heads of a column for each of kPathFigures.
std::string path_figure_heads();

}  // namespace psi_slam
