// SPDX-License-Identifier: BSD-3-Clause
// The main function of the programs for clusters. Rank 0 of an MPI job hands out orders, the other ranks
// carry them out. Orders and outcomes travel as texts.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/workers.h"
#include "config/option_table.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Carries out an order and returns its outcome. Calls `stop` a few times a second and returns nothing if
/// that ended the order.
using MakeOrder =
    std::function<std::optional<std::string>(const std::string& order, const std::function<bool()>& stop)>;

struct MpiProgram {
  std::string name;
  std::string description;
  std::string examples;  ///< end of --help
  /// Adds the options to `app` and returns the work of rank 0, which follows the parsing. Parsing must do
  /// nothing else if `ranks` is 0. Both may throw CLI::ParseError and UserError for mistakes of the user.
  std::function<std::function<int()>(CLI::App& app, int ranks, const Streams& streams)> define;
  /// Carries out one order on another rank.
  MakeOrder make;
  std::shared_ptr<const OptionTable> settings{};  ///< for the documents; may be null
};

/// Runs the program as one rank of a job, or alone, and returns its exit code. --help, --version and
/// documents work without MPI and are printed by one rank.
int run_mpi_program(int argc, char** argv, const MpiProgram& program);

/// Path of another program of psi-slam, installed beside this one or in the same build. Throws UserError if
/// it does not exist.
std::filesystem::path program_beside(const std::string& name, const std::string& own_name);

/// For rank 0 of several: hands out the orders, and returns when all have been carried out or stopped. Waits
/// for all ranks before it rethrows an exception of `watch.finished`.
void hand_out(const std::vector<std::string>& orders, const WorkWatch<std::string>& watch);

/// For rank 0 of several: workers that are the other ranks.
template <class Order, class Outcome>
Workers<Order, Outcome> rank_workers() {
  return [](const std::vector<Order>& orders, const WorkWatch<Outcome>& watch) {
    std::vector<std::string> texts;
    for (const Order& order : orders) texts.push_back(cbor_text(order));
    hand_out(texts, {watch.stop, watch.working, [&](std::size_t order, const std::string& text) {
                       watch.finished(order, read_cbor<Outcome>(text));
                     }});
  };
}

/// For the other ranks: `make` with orders and outcomes as texts.
template <class Order, class Outcome>
MakeOrder text_maker(std::optional<Outcome> (*make)(const Order&, const std::function<bool()>&)) {
  return [make](const std::string& order, const std::function<bool()>& stop) {
    const std::optional<Outcome> outcome = make(read_cbor<Order>(order), stop);
    return outcome ? std::optional(cbor_text(*outcome)) : std::nullopt;
  };
}

}  // namespace psi_slam
