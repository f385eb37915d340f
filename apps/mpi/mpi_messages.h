// SPDX-License-Identifier: BSD-3-Clause
// Texts from rank to rank.
#pragma once

#include <optional>
#include <string>

namespace psi_slam {

enum class MessageKind : int { kOrder = 1, kOutcome, kStop, kEnd };

struct Message {
  int rank = 0;  ///< that sent it
  MessageKind kind = MessageKind::kEnd;
  std::string text;
};

/// MPI from its beginning to its end.
class MpiWorld {
 public:
  MpiWorld(int& argc, char**& argv);
  ~MpiWorld();
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;

  int rank() const;
  int ranks() const;
  void send(int rank, MessageKind kind, const std::string& text = {}) const;

  /// The next message, if one is there.
  std::optional<Message> receive() const;

  /// The same, after a short sleep if there is none: MPI's own waiting keeps a processor busy.
  std::optional<Message> wait() const;
};

}  // namespace psi_slam
