// SPDX-License-Identifier: BSD-3-Clause
// The hidden options of every program that print what is installed beside it.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "config/option_table.h"

namespace psi_slam {

/// Adds --man-page and --bash-completion and, where there are `settings`, --settings-man-page. They are in no
/// help. Given, they end the parsing as --version does, with their text. `app` must outlive the parsing.
void add_document_options(CLI::App& app, std::shared_ptr<const OptionTable> settings = nullptr);

}  // namespace psi_slam
