// SPDX-License-Identifier: BSD-3-Clause
#include "document_options.h"

#include <functional>
#include <string>
#include <utility>

namespace psi_slam {
namespace {

void add_hidden(CLI::App& app, const std::string& name, std::function<std::string()> text) {
  // CLI11 adds a line end to the text of --version, so the document's own is removed.
  app.add_flag_callback(name,
                        [text = std::move(text)] {
                          std::string document = text();
                          if (!document.empty()) document.pop_back();
                          throw CLI::CallForVersion(document, 0);
                        })
      ->group("");
}

}  // namespace

void add_document_options(CLI::App& app, std::shared_ptr<const OptionTable> settings) {
  add_hidden(app, "--man-page", [&app] { return man_page(app); });
  add_hidden(app, "--bash-completion", [&app, settings] { return bash_completion(app, settings.get()); });
  if (settings)
    add_hidden(app, "--settings-man-page",
               [&app, settings] { return settings_man_page(*settings, app.version()); });
}

}  // namespace psi_slam
