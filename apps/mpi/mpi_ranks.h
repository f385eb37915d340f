// SPDX-License-Identifier: BSD-3-Clause
// Work shared out among the ranks of an MPI job: rank 0 hands out orders, the other ranks carry them out.
// Orders and outcomes travel as texts.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/workers.h"

namespace psi_slam {

enum class MessageKind : int { kOrder = 1, kOutcome, kStop, kEnd };

struct Message {
  int rank = 0;  ///< of the sender
  MessageKind kind = MessageKind::kEnd;
  std::string text;
};

/// Initialises MPI and finalises it in the destructor.
class MpiWorld {
 public:
  MpiWorld(int& argc, char**& argv);
  ~MpiWorld();
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;

  int rank() const;
  int ranks() const;
  void send(int rank, MessageKind kind, const std::string& text = {}) const;

  /// Receives the next message, if there is one.
  std::optional<Message> receive() const;

  /// As receive(), after a short sleep without a message: waiting inside MPI would keep a processor busy.
  std::optional<Message> wait() const;
};

/// For rank 0 of several: hands out the orders, and returns when all have been carried out or stopped. Waits
/// for all ranks before it rethrows an exception of `watch.finished`.
void hand_out(const MpiWorld& world, const std::vector<std::string>& orders,
              const WorkWatch<std::string>& watch);

/// Carries out an order and returns its outcome. Calls `stop` a few times a second and returns nothing if
/// that ended the order.
using MakeOrder =
    std::function<std::optional<std::string>(const std::string& order, const std::function<bool()>& stop)>;

/// For the other ranks: carries out orders until rank 0 dismisses them.
void work_for_rank_0(const MpiWorld& world, const MakeOrder& make);

/// For rank 0, at the end.
void dismiss_workers(const MpiWorld& world);

/// For rank 0 of several: workers that are the other ranks. `world` must outlive them.
template <class Order, class Outcome>
Workers<Order, Outcome> rank_workers(const MpiWorld& world, std::string (*text_of)(const Order&),
                                     Outcome (*outcome_of)(const std::string&)) {
  return [&world, text_of, outcome_of](const std::vector<Order>& orders, const WorkWatch<Outcome>& watch) {
    std::vector<std::string> texts;
    for (const Order& order : orders) texts.push_back(text_of(order));
    hand_out(world, texts, {watch.stop, watch.working, [&](std::size_t order, const std::string& text) {
                              watch.finished(order, outcome_of(text));
                            }});
  };
}

/// For the other ranks: `make` with orders and outcomes as texts.
template <class Order, class Outcome>
MakeOrder text_maker(Order (*order_of)(const std::string&),
                     std::optional<Outcome> (*make)(const Order&, const std::function<bool()>&),
                     std::string (*text_of)(const Outcome&)) {
  return [=](const std::string& order, const std::function<bool()>& stop) {
    const std::optional<Outcome> outcome = make(order_of(order), stop);
    return outcome ? std::optional(text_of(*outcome)) : std::nullopt;
  };
}

}  // namespace psi_slam
