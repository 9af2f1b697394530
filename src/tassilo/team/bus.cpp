#include "tassilo/team/bus.h"

#include <dds/dds.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/team/internal/domain.h"
#include "tassilo/team/internal/opaque_type.h"

namespace tassilo {
namespace {

constexpr std::string_view kBuiltin = "org::eclipse::cyclonedds::builtin::";  // types of what a Directory reads
constexpr std::int64_t kPlausibleGap = 1'000'000;
constexpr std::size_t kForgottenKept = 1000;  // endpoints that are gone and may still be named by messages

void check_range(const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    const auto text = [](double number) {
      std::string digits = std::to_string(number);
      digits.erase(digits.find_last_not_of('0') + 1);
      if (digits.back() == '.') digits.pop_back();
      return digits;
    };
    throw Error(field, "is " + text(value) + ", must be in " + text(low) + ".." + text(high));
  }
}

/// Names and addresses of hosts and network interfaces: nothing that means something to the middleware's parser.
void check_host(const char* field, const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
           c == '_';
  };
  if (text.empty() || text.size() > 255 || !std::ranges::all_of(text, is_plain))
    throw Error(field, "is \"" + text + "\", must be a name or an IPv4 address");
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= 255 && std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}
void check_name(const char* field, const std::string& text) {
  if (!is_name(text)) throw Error(field, "is \"" + text + "\", must be 1..255 visible characters without blanks");
}

BusId id_of(const dds_guid_t& guid) {
  BusId id;
  std::copy(std::begin(guid.v), std::end(guid.v), id.bytes.begin());
  return id;
}
BusId id_of(dds_entity_t entity) {
  dds_guid_t guid{};
  dds_get_guid(entity, &guid);
  return id_of(guid);
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

/// As ROS 2 sets it.
Qos qos_of(const BusTopic& topic, const BusOptions& options) {
  Qos qos(dds_create_qos());
  const bool is_reliable = topic.reliability == BusReliability::reliable;
  dds_qset_reliability(qos.get(), is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(options.max_block_ms));
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, topic.depth);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_NONE);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain_cdr);
  return qos;
}

/// Which endpoints of one kind there are, by what the middleware publishes of its own discovery.
class Directory {
 public:
  Directory(dds_entity_t participant, dds_entity_t builtin_topic)
      : reader_(dds_create_reader(participant, builtin_topic, nullptr, nullptr), "cannot listen to discovery"),
        participant_(id_of(participant)) {}

  dds_entity_t reader() const { return reader_.get(); }

  /// Takes what has changed; whether anything has.
  bool update() {
    constexpr std::size_t kAtOnce = 64;
    bool changed = false;
    for (;;) {
      void* samples[kAtOnce] = {};
      dds_sample_info_t infos[kAtOnce];
      const int count = dds_take(reader_.get(), samples, infos, kAtOnce, kAtOnce);
      if (count <= 0) return changed;
      changed = true;
      for (int i = 0; i < count; ++i) note(*static_cast<const dds_builtintopic_endpoint_t*>(samples[i]), infos[i]);
      dds_return_loan(reader_.get(), samples, count);
    }
  }

  std::vector<BusEndpoint> all() const {
    std::vector<BusEndpoint> found;
    for (const auto& [handle, endpoint] : present_) found.push_back(endpoint);
    std::ranges::sort(found, [](const BusEndpoint& a, const BusEndpoint& b) {
      return std::tie(a.topic, a.id) < std::tie(b.topic, b.id);
    });
    return found;
  }
  std::optional<BusId> find(dds_instance_handle_t handle) const {
    if (const auto found = present_.find(handle); found != present_.end()) return found->second.id;
    const auto found = std::ranges::find(gone_, handle, &std::pair<dds_instance_handle_t, BusId>::first);
    return found != gone_.end() ? std::optional(found->second) : std::nullopt;
  }

 private:
  void note(const dds_builtintopic_endpoint_t& told, const dds_sample_info_t& info) {
    const BusId id = id_of(told.key);
    if (info.instance_state != DDS_ALIVE_INSTANCE_STATE) {
      present_.erase(info.instance_handle);
      gone_.emplace_back(info.instance_handle, id);
      if (gone_.size() > kForgottenKept) gone_.pop_front();
      return;
    }
    if (!info.valid_data || told.topic_name == nullptr || told.type_name == nullptr) return;
    if (!is_name(told.topic_name) || !is_name(told.type_name) || std::string_view(told.type_name).starts_with(kBuiltin))
      return;
    dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
    if (told.qos != nullptr) dds_qget_reliability(told.qos, &reliability, nullptr);
    const BusId participant = id_of(told.participant_key);
    present_[info.instance_handle] = {
        id,
        participant,
        told.topic_name,
        told.type_name,
        reliability == DDS_RELIABILITY_RELIABLE ? BusReliability::reliable : BusReliability::best_effort,
        participant == participant_};
  }

  internal::Entity reader_;
  BusId participant_;
  std::map<dds_instance_handle_t, BusEndpoint> present_;
  std::deque<std::pair<dds_instance_handle_t, BusId>> gone_;
};

void add_conflicts(const BusEndpoint& writer, const BusEndpoint& reader, std::vector<std::string>& lines) {
  if (writer.topic != reader.topic || (!writer.is_own && !reader.is_own)) return;
  const std::string who = writer.is_own && reader.is_own ? "a writer and a reader of ours"
                          : writer.is_own                ? "our writer and reader " + to_string(reader.id)
                                                         : "our reader and writer " + to_string(writer.id);
  if (writer.type != reader.type)
    lines.push_back("topic " + writer.topic + ": " + who + " do not talk: the writer's type is " + writer.type +
                    ", the reader's " + reader.type);
  else if (reader.reliability == BusReliability::reliable && writer.reliability == BusReliability::best_effort)
    lines.push_back("topic " + writer.topic + ": " + who +
                    " do not talk: the reader asks for reliable, the writer offers best effort");
}

}  // namespace

namespace internal {

/// What a bus, its readers and its writers share; there until the last of them is gone.
class BusCore {
 public:
  explicit BusCore(const BusOptions& checked)
      : options(checked),
        domain(options),
        participant(dds_create_participant(static_cast<dds_domainid_t>(options.domain), nullptr, nullptr),
                    "cannot take part"),
        publications_(participant.get(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION),
        subscriptions_(participant.get(), DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION),
        wake_condition_(dds_create_guardcondition(participant.get()), "cannot make a condition"),
        waitset_(dds_create_waitset(participant.get()), "cannot make a waitset") {
    attach(publications_.reader());
    attach(subscriptions_.reader());
    attach_condition(wake_condition_.get());
  }

  /// wait() ends when the reader has something to take.
  void attach(dds_entity_t reader) {
    // The condition is the reader's, and goes with it.
    const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
    if (condition < 0) fail("cannot make a condition", condition);
    attach_condition(condition);
  }

  struct Topic {
    Topic(dds_entity_t handle, const ddsi_sertype* its_type) : entity(handle, "cannot use topic"), type(its_type) {}
    Entity entity;
    const ddsi_sertype* type;  ///< Lives as long as the topic's entity.
  };
  std::unique_ptr<Topic> topic(const BusTopic& topic) {
    const std::lock_guard lock(mutex_);
    // Types are told apart by the middleware only where they are announced; a bus has one type a topic.
    const auto [known, is_new] = types_.try_emplace(topic.name, topic.type);
    if (known->second != topic.type)
      throw Error("bus", "topic " + topic.name + " has type " + known->second + " here, cannot be used with type " +
                             topic.type);
    ddsi_sertype* type = make_opaque_type(topic.type, static_cast<std::size_t>(options.max_bytes));
    const dds_entity_t handle =
        dds_create_topic_sertype(participant.get(), topic.name.c_str(), &type, nullptr, nullptr, nullptr);
    if (handle < 0) {
      ddsi_sertype_unref(type);
      if (is_new) types_.erase(known);
      fail("cannot use topic " + topic.name, handle);
    }
    return std::make_unique<Topic>(handle, type);
  }

  std::vector<BusEndpoint> publications() {
    const std::lock_guard lock(mutex_);
    update();
    return publications_.all();
  }
  std::vector<BusEndpoint> subscriptions() {
    const std::lock_guard lock(mutex_);
    update();
    return subscriptions_.all();
  }
  /// Of the writers with these handles; messages come after their writers have been told of.
  std::vector<BusId> writers(std::span<const dds_instance_handle_t> handles) {
    const std::lock_guard lock(mutex_);
    std::vector<BusId> found;
    for (const dds_instance_handle_t handle : handles) {
      std::optional<BusId> id = publications_.find(handle);
      if (!id) {
        update();
        id = publications_.find(handle);
      }
      found.push_back(id.value_or(BusId{}));
    }
    return found;
  }

  bool wait(std::chrono::milliseconds timeout) {
    {
      // What take() or publications() has learned of meanwhile is news to whoever waits.
      const std::lock_guard lock(mutex_);
      if (std::exchange(has_news_, false)) return true;
    }
    const int triggered =
        dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_MSECS(std::max<std::int64_t>(0, timeout.count())));
    bool was_woken = false;
    dds_take_guardcondition(wake_condition_.get(), &was_woken);
    const std::lock_guard lock(mutex_);
    update();
    has_news_ = false;
    return triggered > 0 || was_woken;
  }
  void wake() { dds_set_guardcondition(wake_condition_.get(), true); }

  const BusOptions options;
  const Domain domain;
  const Entity participant;

 private:
  void attach_condition(dds_entity_t condition) {
    const dds_return_t done = dds_waitset_attach(waitset_.get(), condition, 0);
    if (done < 0) fail("cannot wait", done);
  }
  void update() {
    const bool writers = publications_.update(), readers = subscriptions_.update();
    has_news_ = has_news_ || writers || readers;
  }

  std::mutex mutex_;
  Directory publications_, subscriptions_;
  bool has_news_ = false;
  std::map<std::string, std::string> types_;  ///< By topic.
  Entity wake_condition_;
  Entity waitset_;
};

}  // namespace internal

void BusOptions::check() const {
  check_range("bus.domain", domain, 0, 232);
  check_host("bus.interface", interface);
  for (const std::string& peer : peers) check_host("bus.peers", peer);
  if (multicast && (interface == "lo" || interface.starts_with("127.")))
    throw Error("bus.multicast", "is on, must be off on loopback, which has none");
  check_range("bus.max_participants", max_participants, 1, 60);
  check_range("bus.lease_s", lease_s, 1, 60);
  check_range("bus.max_block_ms", max_block_ms, 0, 1000);
  check_range("bus.max_bytes", max_bytes, 1024, 64 << 20);
}

void BusTopic::check() const {
  check_name("bus.topic.name", name);
  check_name("bus.topic.type", type);
  check_range("bus.topic.depth", depth, 1, 1000);
}

std::string wire_topic_name(std::string_view ros_name) { return std::string("rt").append(ros_name); }

std::string ros_topic_name(std::string_view wire_name) {
  return wire_name.starts_with("rt/") ? std::string(wire_name.substr(2)) : "";
}

std::string to_string(const BusId& id) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : id.bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

class BusWriter::Implementation {
 public:
  Implementation(std::shared_ptr<internal::BusCore> shared, const BusTopic& options)
      : core(std::move(shared)),
        topic(core->topic(options)),
        writer(dds_create_writer(core->participant.get(), topic->entity.get(), qos_of(options, core->options).get(),
                                 nullptr),
               "cannot write topic " + options.name),
        name(options.name) {}

  std::shared_ptr<internal::BusCore> core;
  std::unique_ptr<internal::BusCore::Topic> topic;
  internal::Entity writer;
  std::string name;
  std::mutex mutex;  ///< Messages go out in the order of their numbers.
  std::int64_t number = 0;
};

BusWriter::BusWriter(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
BusWriter::BusWriter(BusWriter&&) noexcept = default;
BusWriter& BusWriter::operator=(BusWriter&&) noexcept = default;
BusWriter::~BusWriter() = default;

bool BusWriter::write(std::span<const std::byte> data) {
  Implementation& here = *implementation_;
  if (data.size() < 4 || data.size() > static_cast<std::size_t>(here.core->options.max_bytes))
    throw Error("bus", "message for topic " + here.name + " has " + std::to_string(data.size()) +
                           " bytes, must have 4.." + std::to_string(here.core->options.max_bytes));
  const std::lock_guard lock(here.mutex);
  const dds_return_t done =
      dds_writecdr(here.writer.get(), internal::make_opaque_data(here.topic->type, data, ++here.number));
  if (done == DDS_RETCODE_TIMEOUT) return false;
  if (done < 0) internal::fail("cannot write topic " + here.name, done);
  return true;
}

int BusWriter::readers() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(implementation_->writer.get(), &status);
  return static_cast<int>(status.current_count);
}
BusId BusWriter::id() const { return id_of(implementation_->writer.get()); }

class BusReader::Implementation {
 public:
  Implementation(std::shared_ptr<internal::BusCore> shared, const BusTopic& options)
      : core(std::move(shared)),
        topic(core->topic(options)),
        counts(internal::counts_of(topic->type)),
        reader(dds_create_reader(core->participant.get(), topic->entity.get(), qos_of(options, core->options).get(),
                                 nullptr),
               "cannot read topic " + options.name),
        depth(static_cast<std::size_t>(options.depth)) {
    core->attach(reader.get());
  }

  /// Counts the messages between this one and its writer's last one. Numbers are the sender's word: sums may not
  /// overflow.
  void count_lost(dds_instance_handle_t writer, std::int64_t number) {
    if (number <= 0) return;
    const auto [last, is_first] = last_numbers.try_emplace(writer, number);
    if (!is_first && number > last->second) {
      const std::int64_t gap = number - last->second - 1;
      if (gap <= kPlausibleGap && gap <= std::numeric_limits<std::int64_t>::max() - lost) lost += gap;
      last->second = number;
    }
    // Writers that are gone are not told apart here; a few numbers too many are forgotten without harm.
    if (last_numbers.size() > kForgottenKept) last_numbers.erase(last_numbers.begin());
  }

  std::shared_ptr<internal::BusCore> core;
  std::unique_ptr<internal::BusCore::Topic> topic;
  std::shared_ptr<const internal::OpaqueCounts> counts;
  internal::Entity reader;
  std::size_t depth;
  std::map<dds_instance_handle_t, std::int64_t> last_numbers;  ///< By writer; handles grow, so the first is the oldest.
  std::atomic<std::int64_t> lost = 0;
};

BusReader::BusReader(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
BusReader::BusReader(BusReader&&) noexcept = default;
BusReader& BusReader::operator=(BusReader&&) noexcept = default;
BusReader::~BusReader() = default;

std::vector<BusSample> BusReader::take() {
  Implementation& here = *implementation_;
  // One more than the depth: the middleware adds a sample without content when a writer goes.
  std::vector<ddsi_serdata*> taken(here.depth + 1);
  std::vector<dds_sample_info_t> infos(here.depth + 1);
  const int count = dds_takecdr(here.reader.get(), taken.data(), static_cast<std::uint32_t>(taken.size()), infos.data(),
                                DDS_ANY_STATE);
  std::vector<BusSample> samples;
  std::vector<dds_instance_handle_t> writers;
  for (int i = 0; i < count; ++i) {
    ddsi_serdata* const data = taken[static_cast<std::size_t>(i)];
    const dds_sample_info_t& info = infos[static_cast<std::size_t>(i)];
    if (info.valid_data) {
      internal::OpaqueContent content = internal::content_of(data);
      here.count_lost(info.publication_handle, content.number);
      samples.push_back({std::move(content.data), info.source_timestamp, content.arrival_ns, {}});
      writers.push_back(info.publication_handle);
    }
    ddsi_serdata_unref(data);
  }
  const std::vector<BusId> ids = here.core->writers(writers);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].writer = ids[i];
  return samples;
}

std::int64_t BusReader::lost() const { return implementation_->lost; }
std::int64_t BusReader::refused() const { return implementation_->counts->refused; }
int BusReader::writers() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(implementation_->reader.get(), &status);
  return static_cast<int>(status.current_count);
}

Bus::Bus(const BusOptions& options) {
  options.check();
  core_ = std::make_shared<internal::BusCore>(options);
}
Bus::~Bus() = default;

BusWriter Bus::writer(const BusTopic& topic) {
  topic.check();
  return BusWriter(std::make_unique<BusWriter::Implementation>(core_, topic));
}
BusReader Bus::reader(const BusTopic& topic) {
  topic.check();
  return BusReader(std::make_unique<BusReader::Implementation>(core_, topic));
}

std::vector<BusEndpoint> Bus::publications() const { return core_->publications(); }
std::vector<BusEndpoint> Bus::subscriptions() const { return core_->subscriptions(); }
std::vector<std::string> Bus::conflicts() const {
  std::vector<std::string> lines;
  const std::vector<BusEndpoint> readers = subscriptions();
  for (const BusEndpoint& writer : publications())
    for (const BusEndpoint& reader : readers) add_conflicts(writer, reader, lines);
  return lines;
}

bool Bus::wait(std::chrono::milliseconds timeout) { return core_->wait(timeout); }
void Bus::wake() { core_->wake(); }
BusId Bus::id() const { return id_of(core_->participant.get()); }
std::vector<std::string> Bus::complaints() { return internal::complaints(); }

}  // namespace tassilo
