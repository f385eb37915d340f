// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_program.h"

#include <mpi.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <sstream>
#include <thread>

#include "base/exit_code.h"
#include "document_options.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kBetweenLooks{10};

enum class MessageKind : int { kOrder = 1, kOutcome, kStop, kEnd };

struct Message {
  int rank = 0;  // rank of the sender
  MessageKind kind = MessageKind::kEnd;
  std::string text;
};

/// Initialises MPI and finalises it in the destructor. After an error, MPI prints a message and ends the job.
struct MpiWorld {
  MpiWorld(int& argc, char**& argv) { MPI_Init(&argc, &argv); }
  ~MpiWorld() { MPI_Finalize(); }
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;
};

int own_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int number_of_ranks() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

void send(int rank, MessageKind kind, const std::string& text = {}) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, static_cast<int>(kind),
           MPI_COMM_WORLD);
}

/// Receives the next message if one has arrived. Does not wait.
std::optional<Message> receive() {
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

/// Calls receive(), then sleeps for kBetweenLooks if no message has arrived. Waiting inside MPI would keep a
/// processor busy.
std::optional<Message> wait() {
  std::optional<Message> message = receive();
  if (!message) std::this_thread::sleep_for(kBetweenLooks);
  return message;
}

/// Work of all ranks except 0: carries out orders until rank 0 sends kEnd.
void work_for_rank_0(const MakeOrder& make) {
  for (bool dismissed = false; !dismissed;) {
    const std::optional<Message> message = wait();
    if (message && message->kind == MessageKind::kEnd) return;
    if (!message || message->kind != MessageKind::kOrder)
      continue;  // no message, or a kStop that arrived after its order had ended
    const std::optional<std::string> outcome = make(message->text, [&] {
      const std::optional<Message> other = receive();
      dismissed = dismissed || (other && other->kind == MessageKind::kEnd);
      return dismissed || (other && other->kind == MessageKind::kStop);
    });
    if (!dismissed) send(0, MessageKind::kOutcome, outcome.value_or(""));
  }
}

/// True if a launcher of MPI jobs started this process as a rank other than 0.
bool is_started_as_later_rank() {
  for (const char* variable : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* const rank = std::getenv(variable); rank != nullptr) return std::string(rank) != "0";
  return false;
}

/// Parses the command line, does the work of rank 0 and returns its exit code. Only parses if `ranks` is 0.
int run(CLI::App& app, const MpiProgram& program, int ranks, int argc, char** argv, const Streams& streams) {
  app.description(program.description);
  const std::function<int()> work = program.define(app, ranks, streams);
  app.set_version_flag("--version", program.name + " " PSI_SLAM_VERSION, "Print the version and exit");
  app.footer(program.examples);
  add_document_options(app, {{"All runs are complete.", "A run failed, or the job was interrupted.",
                              "The arguments, the settings or a log are invalid."},
                             program.settings});
  app.parse(argc, argv);
  return ranks > 0 ? work() : kExitDone;
}

/// Returns the text that --help, --version or a hidden document option prints; nothing for other arguments.
std::optional<std::string> words_of_itself(const MpiProgram& program, int argc, char** argv,
                                           const Streams& streams) {
  CLI::App app("", program.name);
  try {
    run(app, program, 0, argc, argv, streams);
  } catch (const CLI::Success& asked) {
    std::ostringstream words;
    app.exit(asked, words, words);
    return words.str();
  } catch (const std::exception&) {  // rank 0 reports the error when MPI runs
  }
  return std::nullopt;
}

}  // namespace

int run_mpi_program(int argc, char** argv, const MpiProgram& program) {
  // Ignores SIGXFSZ, so that a write beyond `ulimit -f` fails instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  const Streams streams{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  if (const auto words = words_of_itself(program, argc, argv, streams)) {
    if (!is_started_as_later_rank()) std::cout << *words << std::flush;
    return std::cout ? kExitDone : kExitFailed;
  }
  const MpiWorld world(argc, argv);
  if (own_rank() > 0) {
    work_for_rank_0(program.make);
    return kExitDone;
  }
  CLI::App app("", program.name);
  const int code = run_program(app, streams.out, streams.err,
                               [&] { return run(app, program, number_of_ranks(), argc, argv, streams); });
  for (int rank = 1; rank < number_of_ranks(); ++rank) send(rank, MessageKind::kEnd);
  return code;
}

fs::path program_beside(const std::string& name, const std::string& own_name) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& program : {folder / name, folder.parent_path() / name / name})
    if (fs::is_regular_file(program)) return program;
  throw UserError(name + ", which makes the runs, was not found: expected it beside " +
                  (folder / own_name).string() + ". Install both programs in one folder");
}

void hand_out(const std::vector<std::string>& orders, const WorkWatch<std::string>& watch) {
  std::vector<int> idle;
  for (int rank = number_of_ranks() - 1; rank > 0; --rank) idle.push_back(rank);
  std::map<int, std::size_t> busy;  // index of the order that each busy rank carries out
  std::size_t next = 0;             // index of the first order that is not handed out
  bool stopped = false;
  std::exception_ptr failure;  // the first exception of watch.finished()
  while (true) {
    while (!idle.empty() && next < orders.size() && !stopped && !watch.stop()) {
      send(idle.back(), MessageKind::kOrder, orders[next]);
      busy[idle.back()] = next++;
      idle.pop_back();
    }
    if (busy.empty()) break;
    if (!stopped && watch.stop()) {
      stopped = true;
      for (const auto& [rank, order] : busy) send(rank, MessageKind::kStop);
    }
    if (const std::optional<Message> message = wait()) {
      const std::size_t order = busy.at(message->rank);
      busy.erase(message->rank);
      idle.push_back(message->rank);
      try {
        if (!message->text.empty()) watch.finished(order, message->text);
      } catch (...) {  // rethrown when all ranks are idle
        if (!failure) failure = std::current_exception();
      }
    }
    for (const auto& [rank, order] : busy) watch.working(order);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace psi_slam
