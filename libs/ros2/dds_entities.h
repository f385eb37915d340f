// SPDX-License-Identifier: BSD-3-Clause
// Helpers for the interface of Cyclone DDS, which is in C.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {

using DdsQos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

inline DdsQos make_dds_qos() {
  return {dds_create_qos(), dds_delete_qos};
}

/// Lets readers that come later get the last `depth` messages of a writer.
inline void latch(dds_qos_t* qos, std::int32_t depth) {
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos, 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
}

/// Returns the entity. Throws UserError if it could not be made. `what` names it: "the topic /scan".
inline dds_entity_t checked_dds(dds_entity_t entity, const std::string& what) {
  if (entity < 0)
    throw UserError("ROS 2: cannot open " + what + ": " + dds_strretcode(entity) +
                    ". Check the network, ROS_DOMAIN_ID, and CYCLONEDDS_URI if it is set");
  return entity;
}

}  // namespace psi_slam
