// SPDX-License-Identifier: BSD-3-Clause
// The matchers that are compared: those of the settings, the paper's own, and the genetic one with one idea
// after the other switched off.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "loop_cases.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "matching/matcher.h"

namespace psi_slam {

/// A row of the tables.
class Contestant {
 public:
  Contestant(std::string name, std::shared_ptr<const Matcher> matcher)
      : name_(std::move(name)), matchers_{std::move(matcher)} {}
  /// One that takes, for each case, the one of these that the case names.
  Contestant(std::string name, std::vector<std::shared_ptr<const Matcher>> adaptive)
      : name_(std::move(name)), matchers_(std::move(adaptive)) {}

  const std::string& name() const { return name_; }
  const Matcher& matcher(const LoopCase& loop_case) const;

 private:
  std::string name_;
  std::vector<std::shared_ptr<const Matcher>> matchers_;
};

enum class Field {
  kAll,       ///< with every ablation
  kMatchers,  ///< csm, csm_ga, ga and ga_paper
};

/// The first is exact CSM, which the others are compared with.
std::vector<Contestant> contestants(Field field, const MapperOptions& options);

}  // namespace psi_slam
