// SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include <new>
#include <ostream>

#include "base/instruction_set.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

std::string parsed_words(const CLI::App& app) {
  std::string words = app.get_name();
  for (const CLI::App* command : app.get_subcommands()) words += ' ' + command->get_name();
  return words;
}

int run_program(const CLI::App& app, std::ostream& out, std::ostream& err, const std::function<int()>& work,
                const int& failed) noexcept {
  const auto fail = [&](const std::string& sentence, int code) {
    err << app.get_name() << ": " << sentence << '\n';
    return code;
  };
  try {
    can_use(InstructionSet::kBaseline);  // refuses a wrong environment variable before work begins
    const int code = work();
    out.flush();
    return out ? code : fail("cannot write to standard output", failed);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, out, err);
    out.flush();
    return out ? kExitDone : fail("cannot write to standard output", failed);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + " (see " + parsed_words(app) + " --help)",
                kExitWrongUsageOrInput);
  } catch (const UserError& error) {
    return fail(error.what(), kExitWrongUsageOrInput);
  } catch (const std::bad_alloc&) {
    return fail("there is not enough memory", failed);
  } catch (const std::exception& error) {
    return fail(error.what(), failed);
  }
}

}  // namespace psi_slam
