// SPDX-License-Identifier: BSD-3-Clause
// The main function of a program for clusters. Rank 0 of an MPI job hands out orders, and all other ranks
// carry them out. Orders and outcomes are sent as text.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/config/option_table.h"
#include "batch/workers.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Carries out an order and returns its outcome, a text that is not empty. Calls `stop` a few times a second.
/// Ends the order and returns nothing when `stop` returns true.
using MakeOrder =
    std::function<std::optional<std::string>(const std::string& order, const std::function<bool()>& stop)>;

struct MpiProgram {
  std::string name;
  std::string description;
  std::string examples;  ///< printed at the end of --help
  /// Adds the options to `app` and returns the work of rank 0, which is called after parsing. `ranks` is the
  /// number of ranks of the job, or 0 if the work is not called. Parsing must then have no side effects.
  /// Parsing and work may throw CLI::ParseError and UserError for mistakes of the user.
  std::function<std::function<int()>(CLI::App& app, int ranks, const Streams& streams)> define;
  /// Carries out one order on a rank other than 0.
  MakeOrder make;
  std::shared_ptr<const OptionTable> settings{};  ///< settings in man page and completion; may be null
};

/// Runs the program as one rank of a job, or alone, and returns its exit code. --help, --version and the
/// hidden options for documents work without MPI, and only one rank prints them.
int run_mpi_program(int argc, char** argv, const MpiProgram& program);

/// Path of another program of psi-slam, installed beside this one or in the same build. `own_name` is the
/// name of this program, for the error message. Throws UserError if the other program does not exist.
std::filesystem::path program_beside(const std::string& name, const std::string& own_name);

/// Sends the orders to the other ranks, and returns when all are carried out or stopped. Call it in rank 0 of
/// a job with several ranks. Rethrows the first exception of `watch.finished` when all ranks are idle.
void hand_out(const std::vector<std::string>& orders, const WorkWatch<std::string>& watch);

/// Returns workers for rank 0 of a job with several ranks, which send the orders to all other ranks.
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

/// Returns a MakeOrder for all ranks except 0. It calls `make` and converts orders and outcomes from and to
/// CBOR text.
template <class Order, class Outcome>
MakeOrder text_maker(std::optional<Outcome> (*make)(const Order&, const std::function<bool()>&)) {
  return [make](const std::string& order, const std::function<bool()>& stop) {
    const std::optional<Outcome> outcome = make(read_cbor<Order>(order), stop);
    return outcome ? std::optional(cbor_text(*outcome)) : std::nullopt;
  };
}

}  // namespace psi_slam
