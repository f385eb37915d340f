// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/configuration.h"

#include "session/settings.h"

namespace psi_slam {

class Configuration::Implementation {
 public:
  /// Derives the options of mapper, localizer and log reader from the settings again.
  void update() {
    mapper = psi_slam::mapper_options(bound.settings);
    localizer = localizer_options(bound.settings);
    log = log_options(bound.settings);
    for (std::string& warning : bound.table.take_warnings()) warnings.push_back(std::move(warning));
  }

  BoundSettings bound;
  MapperOptions mapper;
  LocalizerOptions localizer;
  LogOptions log;
  std::vector<std::string> warnings;
};

Configuration::Configuration() : implementation_(std::make_unique<Implementation>()) {
  implementation_->update();
}

Configuration::Configuration(const Configuration& other) : Configuration() {
  *this = other;
}

Configuration& Configuration::operator=(const Configuration& other) {
  implementation_->bound.settings = other.implementation_->bound.settings;
  implementation_->warnings = other.implementation_->warnings;
  implementation_->update();
  return *this;
}

Configuration::~Configuration() = default;

void Configuration::load(const std::filesystem::path& ini) {
  implementation_->bound.load(ini, {});
  implementation_->update();
}

void Configuration::set(std::string_view name, std::string_view value) {
  implementation_->bound.table.set_any(name, value, "Configuration::set");
  implementation_->update();
}

std::string Configuration::value(std::string_view name) const {
  return implementation_->bound.table.option_or_constant(name, "Configuration::value").text();
}

std::string Configuration::text() const {
  return settings_file_text(implementation_->bound.table);
}

const std::vector<std::string>& Configuration::warnings() const {
  return implementation_->warnings;
}

void Configuration::check() const {
  check_values(implementation_->bound.settings);
}

std::shared_ptr<const MapperOptions> Configuration::mapper_options() const {
  return std::make_shared<const MapperOptions>(static_cast<const MapperOptions&>(*this));
}

Configuration::operator const Settings&() const {
  return implementation_->bound.settings;
}

Configuration::operator const MapperOptions&() const {
  check();
  return implementation_->mapper;
}

Configuration::operator const LocalizerOptions&() const {
  check();
  return implementation_->localizer;
}

Configuration::operator const LogOptions&() const {
  check();
  return implementation_->log;
}

Configuration::operator const GridMapOptions&() const {
  check();
  return implementation_->bound.settings.map;
}

}  // namespace psi_slam
