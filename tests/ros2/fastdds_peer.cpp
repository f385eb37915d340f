// SPDX-License-Identifier: BSD-3-Clause
// A robot and its other programs as ROS 2 has them by default: with Fast DDS, which is independent of
// psi-slam's Cyclone DDS. Tests speak to psi-slam through it. Its types are made from ros2_messages.idl by
// fastddsgen.
//
//     fastdds_peer publish FILE                    publishes the lines of FILE, see Publisher::publish()
//     fastdds_peer listen SECONDS TOPIC TYPE ...   prints what comes, one JSON line each; TYPE:latched gets
//     earlier messages, too
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#if __has_include(<fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>)  // Fast DDS 3
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include "ros2_messages.hpp"
#include "ros2_messagesPubSubTypes.hpp"
namespace rtps = eprosima::fastdds::rtps;
namespace policies = eprosima::fastdds::rtps;
#define PSI_SLAM_OK eprosima::fastdds::dds::RETCODE_OK
#else
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include "ros2_messages.h"
#include "ros2_messagesPubSubTypes.h"
namespace rtps = eprosima::fastrtps::rtps;
namespace policies = eprosima::fastrtps::rtps;
#define PSI_SLAM_OK ReturnCode_t::RETCODE_OK
#endif

namespace fdds = eprosima::fastdds::dds;

namespace {

int domain() {
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  return text != nullptr ? std::atoi(text) : 0;
}

rtps::Locator_t loopback(std::uint32_t port) {
  rtps::Locator_t locator(LOCATOR_KIND_UDPv4, port);
  const std::uint8_t address[4] = {127, 0, 0, 1};
  std::copy(std::begin(address), std::end(address), locator.address + 12);
  return locator;
}

/// A participant on the loopback interface, which finds others by their ports.
fdds::DomainParticipant* open_participant() {
  fdds::DomainParticipantQos qos;
  const std::string user_data = "enclave=/;";
  qos.user_data().data_vec(std::vector<unsigned char>(user_data.begin(), user_data.end()));
  const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.push_back("127.0.0.1");
  transport->sendBufferSize = transport->receiveBufferSize = 4 * 1024 * 1024;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  auto& builtin = qos.wire_protocol().builtin;
  // The usual 3 s would make tests wait, because one that starts later does not hear the others.
  builtin.discovery_config.leaseDuration_announcementperiod = {0, 500'000'000};
  builtin.metatrafficUnicastLocatorList.push_back(loopback(0));  // no multicast
  for (std::uint32_t index = 0; index < 12; ++index)
    builtin.initialPeersList.push_back(
        loopback(7400 + 250 * static_cast<std::uint32_t>(domain()) + 10 + 2 * index));
  return fdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(domain()), qos);
}

std::string dds_topic(const std::string& topic) {
  return topic.front() == '/' ? "rt" + topic : topic;
}

template <class PubSubType>
fdds::Topic* make_topic(fdds::DomainParticipant& participant, const std::string& name) {
  const fdds::TypeSupport type(new PubSubType());
  type.register_type(&participant);
  return participant.create_topic(dds_topic(name), type.get_type_name(), fdds::TOPIC_QOS_DEFAULT);
}

builtin_interfaces::msg::dds_::Time_ time_of(std::int64_t stamp_ns) {
  builtin_interfaces::msg::dds_::Time_ time;
  time.sec(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  time.nanosec(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  return time;
}

std_msgs::msg::dds_::Header_ header(std::int64_t stamp_ns, const std::string& frame) {
  std_msgs::msg::dds_::Header_ header;
  header.stamp(time_of(stamp_ns));
  header.frame_id(frame);
  return header;
}

geometry_msgs::msg::dds_::Quaternion_ rotation(double yaw_rad) {
  geometry_msgs::msg::dds_::Quaternion_ rotation;
  rotation.z(std::sin(yaw_rad / 2));
  rotation.w(std::cos(yaw_rad / 2));
  return rotation;
}

/// Publishes messages that are described by lines of text.
class Publisher {
 public:
  Publisher()
      : participant_(open_participant()),
        publisher_(participant_->create_publisher(fdds::PUBLISHER_QOS_DEFAULT)) {}

  void publish(const std::string& line) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "scan") {  // TOPIC FRAME STAMP_NS ANGLE_MIN ANGLE_INCREMENT RANGE_MIN RANGE_MAX R0 R1 ...
      std::string topic, frame, word;
      std::int64_t stamp_ns = 0;
      sensor_msgs::msg::dds_::LaserScan_ scan;
      words >> topic >> frame >> stamp_ns;
      const auto number = [&] {
        words >> word;
        return std::strtof(word.c_str(), nullptr);
      };
      scan.header(header(stamp_ns, frame));
      scan.angle_min(number());
      scan.angle_increment(number());
      scan.range_min(number());
      scan.range_max(number());
      while (words >> word) scan.ranges().push_back(std::strtof(word.c_str(), nullptr));
      scan.angle_max(scan.angle_min() +
                     scan.angle_increment() * static_cast<float>(scan.ranges().size() - 1));
      write<sensor_msgs::msg::dds_::LaserScan_PubSubType>(topic, scan, false,
                                                          true);  // best effort, as drivers do
    } else if (kind == "tf" || kind == "odom") {                  // TOPIC PARENT CHILD STAMP_NS X Y YAW
      std::string topic, parent, child;
      std::int64_t stamp_ns = 0;
      double x_m = 0, y_m = 0, yaw_rad = 0;
      words >> topic >> parent >> child >> stamp_ns >> x_m >> y_m >> yaw_rad;
      if (kind == "tf") {
        geometry_msgs::msg::dds_::TransformStamped_ transform;
        transform.header(header(stamp_ns, parent));
        transform.child_frame_id(child);
        transform.transform().translation().x(x_m);
        transform.transform().translation().y(y_m);
        transform.transform().rotation(rotation(yaw_rad));
        tf2_msgs::msg::dds_::TFMessage_ message;
        message.transforms().push_back(transform);
        write<tf2_msgs::msg::dds_::TFMessage_PubSubType>(topic, message,
                                                         topic.find("static") != std::string::npos);
      } else {
        nav_msgs::msg::dds_::Odometry_ message;
        message.header(header(stamp_ns, parent));
        message.child_frame_id(child);
        message.pose().pose().position().x(x_m);
        message.pose().pose().position().y(y_m);
        message.pose().pose().orientation(rotation(yaw_rad));
        write<nav_msgs::msg::dds_::Odometry_PubSubType>(topic, message);
      }
    } else if (kind == "initialpose") {  // TOPIC FRAME X Y YAW
      std::string topic, frame;
      double x_m = 0, y_m = 0, yaw_rad = 0;
      words >> topic >> frame >> x_m >> y_m >> yaw_rad;
      geometry_msgs::msg::dds_::PoseWithCovarianceStamped_ message;
      message.header(header(0, frame));
      message.pose().pose().position().x(x_m);
      message.pose().pose().position().y(y_m);
      message.pose().pose().orientation(rotation(yaw_rad));
      write<geometry_msgs::msg::dds_::PoseWithCovarianceStamped_PubSubType>(topic, message);
    } else if (kind == "string") {  // TOPIC TEXT
      std::string topic, text;
      words >> topic;
      std::getline(words >> std::ws, text);
      std_msgs::msg::dds_::String_ message;
      message.data(text);
      write<std_msgs::msg::dds_::String_PubSubType>(topic, message);
    } else if (kind == "sleep") {  // SECONDS
      double time_s = 0;
      words >> time_s;
      std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
    }
  }

 private:
  template <class PubSubType, class Message>
  void write(const std::string& topic, Message& message, bool is_latched = false,
             bool is_best_effort = false) {
    fdds::DataWriter*& writer = writers_[topic];
    if (writer == nullptr) {
      fdds::DataWriterQos qos;
      qos.endpoint().history_memory_policy = policies::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      qos.reliability().kind =
          is_best_effort ? fdds::BEST_EFFORT_RELIABILITY_QOS : fdds::RELIABLE_RELIABILITY_QOS;
      qos.durability().kind =
          is_latched ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
      qos.history().depth = 100;
      writer = publisher_->create_datawriter(make_topic<PubSubType>(*participant_, topic), qos);
      for (int tries = 0; tries < 200; ++tries) {
        fdds::PublicationMatchedStatus status;
        writer->get_publication_matched_status(status);
        if (status.current_count > 0) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the reader may not know the writer yet
    }
    writer->write(&message);
  }

  fdds::DomainParticipant* participant_;
  fdds::Publisher* publisher_;
  std::map<std::string, fdds::DataWriter*> writers_;
};

std::string text(const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + '"';
}

std::string number(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

std::string json(const builtin_interfaces::msg::dds_::Time_& time) {
  return std::to_string(std::int64_t{time.sec()} * 1'000'000'000 + time.nanosec());
}
std::string json(const std_msgs::msg::dds_::Header_& header) {
  return "\"stamp_ns\":" + json(header.stamp()) + ",\"frame\":" + text(header.frame_id());
}
std::string json(const geometry_msgs::msg::dds_::Pose_& pose) {
  const double yaw_rad = 2 * std::atan2(pose.orientation().z(), pose.orientation().w());
  return "[" + number(pose.position().x()) + "," + number(pose.position().y()) + "," + number(yaw_rad) + "]";
}
std::string fields(const std_msgs::msg::dds_::String_& message) {
  return "\"data\":" + text(message.data());
}
std::string fields(const rosgraph_msgs::msg::dds_::Clock_& message) {
  return "\"clock_ns\":" + json(message.clock());
}
std::string fields(const sensor_msgs::msg::dds_::LaserScan_& scan) {
  double sum = 0;
  for (const float range_m : scan.ranges()) sum += std::isfinite(range_m) ? static_cast<double>(range_m) : 0;
  return json(scan.header()) + ",\"angle_min\":" + number(static_cast<double>(scan.angle_min())) +
         ",\"angle_increment\":" + number(static_cast<double>(scan.angle_increment())) +
         ",\"range_max\":" + number(static_cast<double>(scan.range_max())) +
         ",\"beams\":" + std::to_string(scan.ranges().size()) + ",\"sum_m\":" + number(sum);
}
std::string fields(const tf2_msgs::msg::dds_::TFMessage_& message) {
  std::string list;
  for (const auto& one : message.transforms()) {
    geometry_msgs::msg::dds_::Pose_ pose;
    pose.position().x(one.transform().translation().x());
    pose.position().y(one.transform().translation().y());
    pose.orientation(one.transform().rotation());
    list += (list.empty() ? "{" : ",{") + json(one.header()) + ",\"child\":" + text(one.child_frame_id()) +
            ",\"pose\":" + json(pose) + "}";
  }
  return "\"transforms\":[" + list + "]";
}
std::string fields(const nav_msgs::msg::dds_::Odometry_& message) {
  return json(message.header()) + ",\"child\":" + text(message.child_frame_id()) +
         ",\"pose\":" + json(message.pose().pose());
}
std::string fields(const nav_msgs::msg::dds_::MapMetaData_& info) {
  return "\"width\":" + std::to_string(info.width()) + ",\"height\":" + std::to_string(info.height()) +
         ",\"resolution\":" + number(static_cast<double>(info.resolution())) +
         ",\"origin\":" + json(info.origin());
}
std::string fields(const nav_msgs::msg::dds_::OccupancyGrid_& map) {
  std::size_t free = 0, occupied = 0, unknown = 0;
  for (const auto cell : map.data())
    ++(static_cast<std::int8_t>(cell) == 0     ? free
       : static_cast<std::int8_t>(cell) == 100 ? occupied
                                               : unknown);
  return json(map.header()) + "," + fields(map.info()) + ",\"cells\":" + std::to_string(map.data().size()) +
         ",\"free\":" + std::to_string(free) + ",\"occupied\":" + std::to_string(occupied) +
         ",\"unknown\":" + std::to_string(unknown);
}
std::string fields(const geometry_msgs::msg::dds_::PoseWithCovarianceStamped_& message) {
  std::string covariance;
  for (const double value : message.pose().covariance())
    covariance += (covariance.empty() ? "" : ",") + number(value);
  return json(message.header()) + ",\"pose\":" + json(message.pose().pose()) + ",\"covariance\":[" +
         covariance + "]";
}
std::string fields(const nav_msgs::msg::dds_::Path_& path) {
  std::string fields = json(path.header()) + ",\"poses\":" + std::to_string(path.poses().size());
  if (!path.poses().empty())
    fields += ",\"last_stamp_ns\":" + json(path.poses().back().header().stamp()) +
              ",\"last\":" + json(path.poses().back().pose());
  return fields;
}
std::string fields(const visualization_msgs::msg::dds_::MarkerArray_& message) {
  std::string list;
  for (const auto& marker : message.markers())
    list += (list.empty() ? "{" : ",{") + json(marker.header()) + ",\"ns\":" + text(marker.ns()) +
            ",\"type\":" + std::to_string(marker.type()) +
            ",\"points\":" + std::to_string(marker.points().size()) +
            ",\"alpha\":" + number(static_cast<double>(marker.color().a())) + "}";
  return "\"markers\":[" + list + "]";
}
std::string fields(const diagnostic_msgs::msg::dds_::DiagnosticArray_& message) {
  std::string list;
  for (const auto& status : message.status()) {
    std::string values;
    for (const auto& value : status.values())
      values += (values.empty() ? "" : ",") + text(value.key()) + ":" + text(value.value());
    list += (list.empty() ? "{" : ",{") + std::string("\"level\":") + std::to_string(int{status.level()}) +
            ",\"name\":" + text(status.name()) + ",\"message\":" + text(status.message()) + ",\"values\":{" +
            values + "}}";
  }
  return "\"status\":[" + list + "]";
}
std::string fields(const rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_& message) {
  std::string list;
  for (const auto& node : message.node_entities_info_seq())
    list += (list.empty() ? "{" : ",{") + std::string("\"namespace\":") + text(node.node_namespace()) +
            ",\"name\":" + text(node.node_name()) +
            ",\"readers\":" + std::to_string(node.reader_gid_seq().size()) +
            ",\"writers\":" + std::to_string(node.writer_gid_seq().size()) + "}";
  return "\"nodes\":[" + list + "]";
}

/// Prints the messages of some topics.
class Listener {
 public:
  Listener()
      : participant_(open_participant()),
        subscriber_(participant_->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT)) {}

  void listen(const std::string& topic, const std::string& type_and_quality) {
    const std::size_t colon = type_and_quality.find(':');
    const std::string type = type_and_quality.substr(0, colon);
    const bool is_latched = colon != std::string::npos;
    static const std::map<std::string, void (Listener::*)(const std::string&, bool)> add_of_type{
        {"String", &Listener::add<std_msgs::msg::dds_::String_, std_msgs::msg::dds_::String_PubSubType>},
        {"Clock",
         &Listener::add<rosgraph_msgs::msg::dds_::Clock_, rosgraph_msgs::msg::dds_::Clock_PubSubType>},
        {"LaserScan",
         &Listener::add<sensor_msgs::msg::dds_::LaserScan_, sensor_msgs::msg::dds_::LaserScan_PubSubType>},
        {"TFMessage",
         &Listener::add<tf2_msgs::msg::dds_::TFMessage_, tf2_msgs::msg::dds_::TFMessage_PubSubType>},
        {"Odometry",
         &Listener::add<nav_msgs::msg::dds_::Odometry_, nav_msgs::msg::dds_::Odometry_PubSubType>},
        {"OccupancyGrid",
         &Listener::add<nav_msgs::msg::dds_::OccupancyGrid_, nav_msgs::msg::dds_::OccupancyGrid_PubSubType>},
        {"MapMetaData",
         &Listener::add<nav_msgs::msg::dds_::MapMetaData_, nav_msgs::msg::dds_::MapMetaData_PubSubType>},
        {"PoseWithCovarianceStamped",
         &Listener::add<geometry_msgs::msg::dds_::PoseWithCovarianceStamped_,
                        geometry_msgs::msg::dds_::PoseWithCovarianceStamped_PubSubType>},
        {"Path", &Listener::add<nav_msgs::msg::dds_::Path_, nav_msgs::msg::dds_::Path_PubSubType>},
        {"MarkerArray", &Listener::add<visualization_msgs::msg::dds_::MarkerArray_,
                                       visualization_msgs::msg::dds_::MarkerArray_PubSubType>},
        {"DiagnosticArray", &Listener::add<diagnostic_msgs::msg::dds_::DiagnosticArray_,
                                           diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>},
        {"ParticipantEntitiesInfo",
         &Listener::add<rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_,
                        rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_PubSubType>}};
    (this->*add_of_type.at(type))(topic, is_latched);
  }

  void print_for(double time_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(time_s);
    while (std::chrono::steady_clock::now() < end) {
      for (const auto& print : readers_) print();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

 private:
  template <class Message, class PubSubType>
  void add(const std::string& topic, bool is_latched) {
    fdds::DataReaderQos qos;
    qos.endpoint().history_memory_policy = policies::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.reliability().kind = is_latched ? fdds::RELIABLE_RELIABILITY_QOS : fdds::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = is_latched ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS : fdds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 500;
    fdds::DataReader* const reader =
        subscriber_->create_datareader(make_topic<PubSubType>(*participant_, topic), qos);
    readers_.push_back([=] {
      Message message;
      fdds::SampleInfo info;
      while (reader->take_next_sample(&message, &info) == PSI_SLAM_OK)
        if (info.valid_data)
          std::cout << "{\"topic\":" << text(topic) << "," << fields(message) << "}" << std::endl;
    });
  }

  fdds::DomainParticipant* participant_;
  fdds::Subscriber* subscriber_;
  std::vector<std::function<void()>> readers_;
};

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  if (arguments.size() == 2 && arguments[0] == "publish") {
    Publisher publisher;
    std::ifstream file(arguments[1]);
    for (std::string line; std::getline(file, line);) publisher.publish(line);
    std::this_thread::sleep_for(
        std::chrono::milliseconds(500));  // reliable readers may ask for messages again
    return 0;
  }
  if (arguments.size() >= 4 && arguments.size() % 2 == 0 && arguments[0] == "listen") {
    Listener listener;
    for (std::size_t i = 2; i + 1 < arguments.size(); i += 2) listener.listen(arguments[i], arguments[i + 1]);
    listener.print_for(std::atof(arguments[1].c_str()));
    return 0;
  }
  std::cerr << "usage: fastdds_peer publish FILE, or fastdds_peer listen SECONDS TOPIC TYPE ...\n";
  return 2;
}
