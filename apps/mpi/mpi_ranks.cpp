// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_ranks.h"

#include <mpi.h>

#include <chrono>
#include <exception>
#include <map>
#include <thread>

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{10};

/// The state of handing out: which rank carries out which order.
class HandingOut {
 public:
  HandingOut(const MpiWorld& world, const std::vector<std::string>& orders,
             const WorkWatch<std::string>& watch)
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
    } catch (...) {  // wait for the other ranks first
      if (!failure_) failure_ = std::current_exception();
    }
  }

  const MpiWorld& world_;
  const std::vector<std::string>& orders_;
  const WorkWatch<std::string>& watch_;
  std::vector<int> idle_;
  std::map<int, std::size_t> busy_;  // order by rank
  std::size_t next_ = 0;             // the first order that is not handed out
  bool stopped_ = false;
  std::exception_ptr failure_;  // the first exception of watch_.finished()
};

}  // namespace

MpiWorld::MpiWorld(int& argc, char**& argv) {
  MPI_Init(&argc, &argv);  // an error in MPI ends the job with a message of MPI
}

MpiWorld::~MpiWorld() {
  MPI_Finalize();
}

int MpiWorld::rank() const {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int MpiWorld::ranks() const {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

void MpiWorld::send(int rank, MessageKind kind, const std::string& text) const {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, static_cast<int>(kind),
           MPI_COMM_WORLD);
}

std::optional<Message> MpiWorld::receive() const {
  int there = 0;
  MPI_Status status{};
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return std::nullopt;
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  Message message{status.MPI_SOURCE, static_cast<MessageKind>(status.MPI_TAG), std::string(size, '\0')};
  MPI_Recv(message.text.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, &status);
  return message;
}

std::optional<Message> MpiWorld::wait() const {
  std::optional<Message> message = receive();
  if (!message) std::this_thread::sleep_for(kBetweenLooks);
  return message;
}

void hand_out(const MpiWorld& world, const std::vector<std::string>& orders,
              const WorkWatch<std::string>& watch) {
  HandingOut(world, orders, watch).run();
}

void work_for_rank_0(const MpiWorld& world, const MakeOrder& make) {
  for (bool dismissed = false; !dismissed;) {
    const std::optional<Message> message = world.wait();
    if (message && message->kind == MessageKind::kEnd) return;
    if (!message || message->kind != MessageKind::kOrder)
      continue;  // a stop that came after the end of the order
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
