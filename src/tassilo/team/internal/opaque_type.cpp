#include "tassilo/team/internal/opaque_type.h"

#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "tassilo/base/contract.h"

namespace tassilo::internal {
namespace {

constexpr std::size_t kHeader = 4;  // of encapsulation: two bytes for the kind, two for options [B]

/// Payloads are sent in whole words; how many bytes were added stands in the last two bits of the header's options
/// (DDS-XTypes 1.3, 7.6.3.1.2).
constexpr std::size_t padding_of(std::size_t size) { return (4 - size % 4) % 4; }

struct OpaqueType : ddsi_sertype {
  std::size_t max_bytes = 0;
  std::shared_ptr<OpaqueCounts> counts;
};

struct OpaqueData : ddsi_serdata {
  std::vector<std::byte> wire;  ///< Whole words; empty for the data that stands for "the key", of which there is none.
  std::size_t size = 0;         ///< Without the padding.
  std::int64_t arrival_ns = 0;
  std::int64_t number = 0;
};

const OpaqueData& opaque(const ddsi_serdata* data) { return *static_cast<const OpaqueData*>(data); }
const OpaqueType& opaque(const ddsi_sertype* type) { return *static_cast<const OpaqueType*>(type); }

/// Memory that is not to be had is no message, not the end of the middleware's thread.
OpaqueData* new_data(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto data = std::unique_ptr<OpaqueData>(new (std::nothrow) OpaqueData);
  if (data == nullptr) return nullptr;
  try {
    data->wire.resize(size + padding_of(size));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  ddsi_serdata_init(data.get(), type, kind);
  data->hash = type->serdata_basehash;
  data->size = size;
  data->arrival_ns = dds_time();
  return data.release();
}

void refuse(const ddsi_sertype* type) { ++opaque(type).counts->refused; }

/// The writer's number of the message that a fragment is of, as it stands in the packet; 0 where there is none. The
/// middleware has brought it into this machine's byte order.
std::int64_t number_of(const nn_rdata& fragment) {
  const unsigned offset = NN_RDATA_SUBMSG_OFF(&fragment);
  if (offset == 0) return 0;
  Data_DataFrag_common_t head;
  std::memcpy(&head, NN_RMSG_PAYLOADOFF(fragment.rmsg, offset), sizeof head);
  if (head.smhdr.submessageId != SMID_DATA && head.smhdr.submessageId != SMID_DATA_FRAG) return 0;
  const auto number = static_cast<std::int64_t>(
      static_cast<std::uint64_t>(static_cast<std::uint32_t>(head.writerSN.high)) << 32 | head.writerSN.low);
  return std::max<std::int64_t>(0, number);
}

/// What was received is whole: takes the padding off that its header tells of. Who sends no whole words has added none.
void unpad(OpaqueData& data, std::size_t received) {
  const std::size_t padding = received % 4 == 0 ? static_cast<std::size_t>(data.wire[3]) & 3 : 0;
  data.size = received - std::min(padding, received - kHeader);
}

extern "C" {

// Data.

uint32_t size_of_data(const ddsi_serdata* data) { return static_cast<uint32_t>(opaque(data).wire.size()); }
void free_data(ddsi_serdata* data) { delete static_cast<OpaqueData*>(data); }
bool equal_keys(const ddsi_serdata*, const ddsi_serdata*) { return true; }

ddsi_serdata* data_from_packets(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragments,
                                size_t size) {
  if (kind != SDK_DATA) return new_data(type, kind, 0);
  if (size < kHeader || size > opaque(type).max_bytes + 3) {
    refuse(type);
    return nullptr;
  }
  OpaqueData* const data = new_data(type, kind, size);
  if (data == nullptr) return nullptr;
  data->number = number_of(*fragments);
  // Fragments are in order, without gaps, and may overlap.
  std::size_t done = 0;
  for (const nn_rdata* fragment = fragments; fragment != nullptr; fragment = fragment->nextfrag) {
    const std::size_t begin = fragment->min, end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= done || begin > done) continue;
    const unsigned char* const payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(data->wire.data() + done, payload + (done - begin), end - done);
    done = end;
  }
  unpad(*data, size);
  return data;
}

ddsi_serdata* data_from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                               const ddsrt_iovec_t* pieces, size_t size) {
  if (kind != SDK_DATA) return new_data(type, kind, 0);
  if (size < kHeader || size > opaque(type).max_bytes + 3) {
    refuse(type);
    return nullptr;
  }
  OpaqueData* const data = new_data(type, kind, size);
  if (data == nullptr) return nullptr;
  std::size_t done = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) && done < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - done);
    std::memcpy(data->wire.data() + done, pieces[i].iov_base, length);
    done += length;
  }
  unpad(*data, size);
  return data;
}

ddsi_serdata* data_from_keyhash(const ddsi_sertype* type, const ddsi_keyhash*) { return new_data(type, SDK_KEY, 0); }
/// Messages are made by make_opaque_data; this is called for what has no content.
ddsi_serdata* data_from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void*) {
  return kind == SDK_DATA ? nullptr : new_data(type, kind, 0);
}
ddsi_serdata* untyped_data(const ddsi_serdata* data) {
  OpaqueData* const untyped = new_data(data->type, SDK_KEY, 0);
  if (untyped != nullptr) untyped->type = nullptr;
  return untyped;
}

void copy_data(const ddsi_serdata* data, size_t offset, size_t size, void* to) {
  const auto& wire = opaque(data).wire;
  const std::size_t begin = std::min(offset, wire.size()), count = std::min(size, wire.size() - begin);
  if (count > 0) std::memcpy(to, wire.data() + begin, count);
  std::memset(static_cast<char*>(to) + count, 0, size - count);
}
ddsi_serdata* lend_data(const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* lent) {
  // Without content there still is a header: "little endian, plain".
  static const unsigned char kNothing[kHeader] = {0, 1, 0, 0};
  const auto& wire = opaque(data).wire;
  const void* const begin = wire.empty() ? static_cast<const void*>(kNothing) : wire.data() + offset;
  lent->iov_base = const_cast<void*>(begin);
  lent->iov_len = wire.empty() ? std::min(size, kHeader) : size;
  return ddsi_serdata_ref(data);
}
void return_data(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

bool data_to_sample(const ddsi_serdata*, void*, void**, void*) { return false; }
bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return false; }
size_t print_data(const ddsi_sertype*, const ddsi_serdata*, char* text, size_t size) {
  if (size > 0) text[0] = 0;
  return 0;
}
void keyhash_of_data(const ddsi_serdata*, ddsi_keyhash* hash, bool) { std::memset(hash, 0, sizeof *hash); }

// Types.

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<OpaqueType*>(type);
}
/// Names have been compared.
bool equal_types(const ddsi_sertype* a, const ddsi_sertype* b) { return opaque(a).max_bytes == opaque(b).max_bytes; }
uint32_t hash_of_type(const ddsi_sertype*) { return 0; }
// Samples as the C API knows them are never asked for: messages are taken as data.
void zero_samples(const ddsi_sertype*, void*, size_t) {}
void realloc_samples(void** samples, const ddsi_sertype*, void*, size_t, size_t count) {
  for (size_t i = 0; i < count; ++i) samples[i] = nullptr;
}
void free_samples(const ddsi_sertype*, void**, size_t, dds_free_op_t) {}

}  // extern "C"

constexpr ddsi_serdata_ops kDataOperations = [] {
  ddsi_serdata_ops operations{};
  operations.eqkey = equal_keys;
  operations.get_size = size_of_data;
  operations.from_ser = data_from_packets;
  operations.from_ser_iov = data_from_pieces;
  operations.from_keyhash = data_from_keyhash;
  operations.from_sample = data_from_sample;
  operations.to_ser = copy_data;
  operations.to_ser_ref = lend_data;
  operations.to_ser_unref = return_data;
  operations.to_sample = data_to_sample;
  operations.to_untyped = untyped_data;
  operations.untyped_to_sample = untyped_to_sample;
  operations.free = free_data;
  operations.print = print_data;
  operations.get_keyhash = keyhash_of_data;
  return operations;
}();

const ddsi_sertype_ops kTypeOperations = [] {
  ddsi_sertype_ops operations{};
  operations.version = ddsi_sertype_v0;
  operations.free = free_type;
  operations.zero_samples = zero_samples;
  operations.realloc_samples = realloc_samples;
  operations.free_samples = free_samples;
  operations.equal = equal_types;
  operations.hash = hash_of_type;
  return operations;
}();

}  // namespace

ddsi_sertype* make_opaque_type(const std::string& type_name, std::size_t max_bytes) {
  auto type = std::make_unique<OpaqueType>();
  ddsi_sertype_init(type.get(), type_name.c_str(), &kTypeOperations, &kDataOperations, true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  type->max_bytes = max_bytes;
  type->counts = std::make_shared<OpaqueCounts>();
  return type.release();
}

std::shared_ptr<const OpaqueCounts> counts_of(const ddsi_sertype* type) { return opaque(type).counts; }

ddsi_serdata* make_opaque_data(const ddsi_sertype* type, std::span<const std::byte> data, std::int64_t number) {
  expects(data.size() >= kHeader && data.size() <= opaque(type).max_bytes,
          "make_opaque_data: a header, and not too much");
  OpaqueData* const made = new_data(type, SDK_DATA, data.size());
  if (made == nullptr) throw std::bad_alloc();
  std::ranges::copy(data, made->wire.begin());
  made->wire[3] = (made->wire[3] & std::byte{0xfc}) | static_cast<std::byte>(padding_of(data.size()));
  made->number = number;
  return made;
}

OpaqueContent content_of(const ddsi_serdata* data) {
  const OpaqueData& from = opaque(data);
  OpaqueContent content{
      {from.wire.begin(), from.wire.begin() + static_cast<std::ptrdiff_t>(from.size)}, from.arrival_ns, from.number};
  if (content.data.size() >= kHeader) content.data[3] &= std::byte{0xfc};
  return content;
}

}  // namespace tassilo::internal
