// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_ranks.h"

#include <exception>
#include <map>

namespace psi_slam {
namespace {

/// Who makes which of the orders.
class HandingOut {
 public:
  HandingOut(const MpiWorld& world, const std::vector<std::string>& orders, const RankWatch& watch)
      : world_(world), orders_(orders), watch_(watch) {
    for (int rank = world.ranks() - 1; rank > 0; --rank) idle_.push_back(rank);
  }

  void run() {
    hand_out();
    while (!busy_.empty()) {
      stop_if_asked();
      if (const std::optional<Message> message = world_.wait()) take(*message);
      for (const auto& [rank, order] : busy_) watch_.working(order);
      hand_out();
    }
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void hand_out() {
    while (!idle_.empty() && next_ < orders_.size() && !stopped_ && !watch_.stop()) {
      world_.send(idle_.back(), MessageKind::kOrder, orders_[next_]);
      busy_[idle_.back()] = next_++;
      idle_.pop_back();
    }
  }

  void stop_if_asked() {
    if (stopped_ || !watch_.stop()) return;
    stopped_ = true;
    for (const auto& [rank, order] : busy_) world_.send(rank, MessageKind::kStop);
  }

  void take(const Message& message) {
    const std::size_t order = busy_.at(message.rank);
    busy_.erase(message.rank);
    idle_.push_back(message.rank);
    if (message.text.empty()) return;
    try {
      watch_.finished(order, message.text);
    } catch (...) {  // the others are heard to their ends all the same
      if (!failure_) failure_ = std::current_exception();
    }
  }

  const MpiWorld& world_;
  const std::vector<std::string>& orders_;
  const RankWatch& watch_;
  std::vector<int> idle_;
  std::map<int, std::size_t> busy_;  // orders by rank
  std::size_t next_ = 0;             // the first order that nobody has
  bool stopped_ = false;
  std::exception_ptr failure_;  // the first of watch_.finished()
};

}  // namespace

void hand_out(const MpiWorld& world, const std::vector<std::string>& orders, const RankWatch& watch) {
  HandingOut(world, orders, watch).run();
}

void work_for_rank_0(const MpiWorld& world, const MakeOrder& make) {
  for (bool dismissed = false; !dismissed;) {
    const std::optional<Message> message = world.wait();
    if (message && message->kind == MessageKind::kEnd) return;
    if (!message || message->kind != MessageKind::kOrder)
      continue;  // told to stop when it had ended by itself
    const std::optional<std::string> outcome = make(message->text, [&] {
      const std::optional<Message> other = world.receive();
      dismissed = dismissed || (other && other->kind == MessageKind::kEnd);
      return dismissed || (other && other->kind == MessageKind::kStop);
    });
    if (!dismissed) world.send(0, MessageKind::kOutcome, outcome.value_or(""));
  }
}

void dismiss_workers(const MpiWorld& world) {
  for (int rank = 1; rank < world.ranks(); ++rank) world.send(rank, MessageKind::kEnd);
}

}  // namespace psi_slam
