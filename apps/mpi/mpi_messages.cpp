// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_messages.h"

#include <mpi.h>

#include <chrono>
#include <thread>

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{10};

}  // namespace

MpiWorld::MpiWorld(int& argc, char**& argv) {
  MPI_Init(&argc, &argv);  // what goes wrong in MPI ends the job, with MPI's own words
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

}  // namespace psi_slam
