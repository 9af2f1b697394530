// A stranger to the team bus: Fast DDS, which shares no code with the middleware that Tassilo uses, and Fast CDR, which
// writes and reads messages field by field. Types, names and settings are those of ROS 2.
//
// Does what the lines of its standard input say, a JSON object each, and answers each with one:
//   {"do": "reader", "topic": .., "type": "pose|scan|image", "reliable": bool}   -> {"ok": true}
//   {"do": "writer", ...}                                                        -> {"ok": true}
//   {"do": "matched", "topic": ..}             -> {"readers": n} or {"writers": n}: those of the topic's writer or
//   reader
//   {"do": "send", "topic": .., "value": ..}   -> {"ok": bool}
//   {"do": "take", "topic": ..}                -> {"value": ..}, null when there is none
// Numbers that are not finite are texts: "inf", "-inf", "nan"; the bytes of images are hexadecimal.
// On loopback only, without multicast and shared memory. usage: fast_dds_peer DOMAIN
#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using nlohmann::json;

json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}
double number(const json& value) {
  return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
}
template <class Numbers>
json numbers(const Numbers& values) {
  json list = json::array();
  for (const auto value : values) list.push_back(number(static_cast<double>(value)));
  return list;
}
template <class Numbers>
void set_numbers(Numbers& values, const json& list) {
  for (std::size_t i = 0; i < list.size(); ++i)
    values.at(i) = static_cast<typename Numbers::value_type>(number(list[i]));
}

// Each message: its type's name, its fields in order, and as JSON.

struct Header {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id;

  template <class Visit>
  void fields(Visit&& visit) {
    visit(sec), visit(nanosec), visit(frame_id);
  }
  void from(const json& value) { sec = value["sec"], nanosec = value["nanosec"], frame_id = value["frame_id"]; }
  json to() const { return {{"sec", sec}, {"nanosec", nanosec}, {"frame_id", frame_id}}; }
};

struct PoseWithCovarianceStamped {
  static constexpr char kName[] = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_";
  Header header;
  std::array<double, 3> position{};
  std::array<double, 4> orientation{};
  std::array<double, 36> covariance{};

  template <class Visit>
  void fields(Visit&& visit) {
    header.fields(visit);
    visit(position), visit(orientation), visit(covariance);
  }
  void from(const json& value) {
    header.from(value);
    set_numbers(position, value["position"]), set_numbers(orientation, value["orientation"]);
    set_numbers(covariance, value["covariance"]);
  }
  json to() const {
    json value = header.to();
    value["position"] = numbers(position), value["orientation"] = numbers(orientation);
    value["covariance"] = numbers(covariance);
    return value;
  }
};

struct LaserScan {
  static constexpr char kName[] = "sensor_msgs::msg::dds_::LaserScan_";
  Header header;
  float angle_min = 0, angle_max = 0, angle_increment = 0, time_increment = 0, scan_time = 0, range_min = 0,
        range_max = 0;
  std::vector<float> ranges, intensities;

  template <class Visit>
  void fields(Visit&& visit) {
    header.fields(visit);
    visit(angle_min), visit(angle_max), visit(angle_increment), visit(time_increment), visit(scan_time);
    visit(range_min), visit(range_max), visit(ranges), visit(intensities);
  }
  void from(const json& value) {
    header.from(value);
    const auto get = [&](const char* name) { return static_cast<float>(number(value[name])); };
    angle_min = get("angle_min"), angle_max = get("angle_max"), angle_increment = get("angle_increment");
    time_increment = get("time_increment"), scan_time = get("scan_time");
    range_min = get("range_min"), range_max = get("range_max");
    ranges.resize(value["ranges"].size()), set_numbers(ranges, value["ranges"]);
    intensities.resize(value["intensities"].size()), set_numbers(intensities, value["intensities"]);
  }
  json to() const {
    json value = header.to();
    value["angle_min"] = number(angle_min), value["angle_max"] = number(angle_max);
    value["angle_increment"] = number(angle_increment), value["time_increment"] = number(time_increment);
    value["scan_time"] = number(scan_time), value["range_min"] = number(range_min),
    value["range_max"] = number(range_max);
    value["ranges"] = numbers(ranges), value["intensities"] = numbers(intensities);
    return value;
  }
};

struct CompressedImage {
  static constexpr char kName[] = "sensor_msgs::msg::dds_::CompressedImage_";
  Header header;
  std::string format;
  std::vector<std::uint8_t> data;

  template <class Visit>
  void fields(Visit&& visit) {
    header.fields(visit);
    visit(format), visit(data);
  }
  void from(const json& value) {
    header.from(value);
    format = value["format"];
    const std::string hex = value["data"];
    data.clear();
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
      data.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  json to() const {
    json value = header.to();
    value["format"] = format;
    std::string hex;
    for (const std::uint8_t byte : data) {
      hex += "0123456789abcdef"[byte >> 4];
      hex += "0123456789abcdef"[byte & 15];
    }
    value["data"] = hex;
    return value;
  }
};

template <class Message>
class Type : public dds::TopicDataType {
 public:
  Type() {
    setName(Message::kName);
    m_typeSize = 1 << 20;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    payload->encapsulation = cdr.endianness() == Cdr::BIG_ENDIANNESS ? CDR_BE : CDR_LE;
    cdr.serialize_encapsulation();
    static_cast<Message*>(data)->fields([&](auto& field) { cdr << field; });
    payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    try {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      cdr.read_encapsulation();
      static_cast<Message*>(data)->fields([&](auto& field) { cdr >> field; });
      return true;
    } catch (const eprosima::fastcdr::exception::Exception& error) {
      std::cerr << "fast_dds_peer: " << error.what() << "\n";
      return false;
    }
  }
  std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
    return [this, data] {
      rtps::SerializedPayload_t payload(m_typeSize);
      serialize(data, &payload);
      return payload.length;
    };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// A reader or a writer, whose messages are JSON.
struct Endpoint {
  dds::DataReader* reader = nullptr;
  dds::DataWriter* writer = nullptr;
  std::function<bool(const json&)> send;
  std::function<json()> take;
};

class Peer {
 public:
  explicit Peer(int domain) {
    dds::DomainParticipantQos qos;
    const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    transport->interfaceWhiteList = {"127.0.0.1"};
    transport->maxInitialPeersRange = 32;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports = {transport};
    rtps::Locator_t here;
    rtps::IPLocator::setIPv4(here, 127, 0, 0, 1);
    qos.wire_protocol().builtin.initialPeersList.push_back(here);
    qos.wire_protocol().builtin.avoid_builtin_multicast = true;
    qos.wire_protocol().builtin.discovery_config.leaseDuration_announcementperiod = {0, 200'000'000};
    participant_ =
        dds::DomainParticipantFactory::get_instance()->create_participant(static_cast<std::uint32_t>(domain), qos);
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~Peer() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  json answer(const json& wish) {
    const std::string verb = wish.at("do"), topic = wish.at("topic");
    if (verb == "reader" || verb == "writer") {
      const std::string type = wish.at("type");
      if (type == "pose") open<PoseWithCovarianceStamped>(wish);
      if (type == "scan") open<LaserScan>(wish);
      if (type == "image") open<CompressedImage>(wish);
      return {{"ok", endpoints_.contains(topic)}};
    }
    const Endpoint& endpoint = endpoints_.at(topic);
    if (verb == "matched" && endpoint.writer != nullptr) {
      dds::PublicationMatchedStatus status;
      endpoint.writer->get_publication_matched_status(status);
      return {{"readers", status.current_count}};
    }
    if (verb == "matched") {
      dds::SubscriptionMatchedStatus status;
      endpoint.reader->get_subscription_matched_status(status);
      return {{"writers", status.current_count}};
    }
    if (verb == "send") return {{"ok", endpoint.send(wish.at("value"))}};
    if (verb == "take") return {{"value", endpoint.take()}};
    return {{"error", "cannot " + verb}};
  }

 private:
  template <class Message>
  void open(const json& wish) {
    const std::string name = wish.at("topic");
    dds::TypeSupport type(new Type<Message>);
    type.register_type(participant_);
    dds::Topic* const topic = participant_->create_topic(name, Message::kName, dds::TOPIC_QOS_DEFAULT);
    const auto reliability = wish.at("reliable") ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    Endpoint& endpoint = endpoints_[name];
    if (wish.at("do") == "writer") {
      dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
      qos.reliability().kind = reliability;
      qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
      qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
      qos.history().depth = 5;
      qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
      qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      endpoint.writer = publisher_->create_datawriter(topic, qos);
      endpoint.send = [writer = endpoint.writer](const json& value) {
        Message message;
        message.from(value);
        return writer->write(&message);
      };
    } else {
      dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
      qos.reliability().kind = reliability;
      qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
      qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
      qos.history().depth = 5;
      qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
      endpoint.reader = subscriber_->create_datareader(topic, qos);
      endpoint.take = [reader = endpoint.reader]() -> json {
        Message message;
        dds::SampleInfo info;
        while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
          if (info.valid_data) return message.to();
        return nullptr;
      };
    }
  }

  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::map<std::string, Endpoint> endpoints_;
};

}  // namespace

int main(int count, char** arguments) {
  try {
    Peer peer(count > 1 ? std::stoi(arguments[1]) : 0);
    std::cout << json{{"ready", true}} << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
      try {
        std::cout << peer.answer(json::parse(line)) << std::endl;
      } catch (const std::exception& error) {
        std::cout << json{{"error", error.what()}} << std::endl;
      }
    }
  } catch (const std::exception& error) {
    std::cout << json{{"error", error.what()}} << std::endl;
    return 1;
  }
  return 0;
}
