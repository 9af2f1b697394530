// Reads a log with what others wrote for it, @mcap/core and Foxglove's decoders of ROS 2 messages, and verifies its checksums: what they read is what we wrote.
//
// usage: node e2e/read_mcap.mjs FILE
// Prints one JSON object a line for each message, in order of log time when the file has an index, else in file order:
//   {"topic", "schema", "log_time", "publish_time" (nanoseconds, as text), "sequence", "message"}
// In messages, 64-bit integers are texts, numbers that JSON has not are "nan", "inf" and "-inf", and arrays of more than 64 bytes are {"bytes": count, "crc32": hex}.
// A file without an end is read up to its last whole record, and standard error says so. Exit code 1: the file is not as it must be.
import { open } from "node:fs/promises";
import { crc32, crc32Final, crc32Init, crc32Update } from "@foxglove/crc";
import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const magic = Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a);
const footer_size = 20;
const piece_size = 1 << 20;
/// The longest array of bytes that is printed as it is.
const long_bytes = 64;

/// A value as JSON can have it.
function plain(value) {
  if (typeof value === "bigint") return value.toString();
  if (typeof value === "number") {
    if (Number.isNaN(value)) return "nan";
    return Number.isFinite(value) ? value : value > 0 ? "inf" : "-inf";
  }
  if (ArrayBuffer.isView(value)) {
    if (value.BYTES_PER_ELEMENT === 1 && value.length > long_bytes) {
      const bytes = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
      return { bytes: bytes.length, crc32: crc32(bytes).toString(16).padStart(8, "0") };
    }
    return Array.from(value, plain);
  }
  if (Array.isArray(value)) return value.map(plain);
  if (value === null || typeof value !== "object") return value;
  const fields = Object.entries(value).map(([key, inner]) => [key, plain(inner)]);
  // The decoder takes times and durations for its own {sec, nsec}, whatever the definition calls them.
  const is_time = fields.length === 2 && fields[0][0] === "sec" && fields[1][0] === "nsec";
  return Object.fromEntries(is_time ? [fields[0], ["nanosec", fields[1][1]]] : fields);
}

/// Prints messages, each by the definition that its file has of it.
function printer() {
  const decoders = new Map();   // by channel
  return (channel, schema, message) => {
    if (channel === undefined) throw new Error(`message ${message.sequence} is on channel ${message.channelId}, which is not described`);
    if (channel.messageEncoding !== "cdr" || schema?.encoding !== "ros2msg")
      throw new Error(`${channel.topic} is ${channel.messageEncoding} by ${schema?.encoding}, must be cdr by ros2msg`);
    let decoder = decoders.get(channel.id);
    if (decoder === undefined) {
      decoder = new serialization.MessageReader(rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true }));
      decoders.set(channel.id, decoder);
    }
    const line = { topic: channel.topic, schema: schema.name, log_time: message.logTime.toString(), publish_time: message.publishTime.toString(),
      sequence: message.sequence, message: plain(decoder.readMessage(message.data)) };
    process.stdout.write(`${JSON.stringify(line)}\n`);
  };
}

/// A file as the reader wants it.
async function readable_of(file) {
  const size = (await file.stat()).size;
  const read = async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
    if (bytesRead !== bytes.length) throw new Error(`ends at byte ${Number(offset) + bytesRead}, must go on to ${offset + length}`);
    return bytes;
  };
  return { size: async () => BigInt(size), read };
}

/// Where the summary begins: 0 without one, undefined for a file without an end.
async function summary_start(readable) {
  const size = await readable.size(), tail = BigInt(magic.length + footer_size);
  if (size < tail) return undefined;
  const bytes = await readable.read(size - tail, tail);
  if (!magic.every((byte, i) => bytes[footer_size + i] === byte)) return undefined;
  return new DataView(bytes.buffer).getBigUint64(0, true);
}

/// The bytes up to there, in pieces.
async function* pieces(readable, end) {
  for (let at = 0n; at < end; at += BigInt(piece_size)) yield await readable.read(at, end - at < piece_size ? end - at : BigInt(piece_size));
}

/// Goes through the file front to back; `take` gets each record.
async function stream(readable, take) {
  const reader = new McapStreamReader({ validateCrcs: true });
  for await (const piece of pieces(readable, await readable.size())) {
    reader.append(piece);
    for (let record; (record = reader.nextRecord()); ) take(record);
  }
  return reader;
}

async function read_without_index(readable, print) {
  const schemas = new Map(), channels = new Map();
  const reader = await stream(readable, (record) => {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") print(channels.get(record.channelId), schemas.get(channels.get(record.channelId)?.schemaId), record);
  });
  if (!reader.done()) console.error(`has no end: ${reader.bytesRemaining()} bytes after its last whole record`);
}

/// What is not read by the index must be right, too: the file front to back, and the checksum of its data, which end there.
async function verify_data(readable, end) {
  let wanted = 0;
  const reader = await stream(readable, (record) => {
    if (record.type === "DataEnd") wanted = record.dataSectionCrc;
  });
  if (!reader.done()) throw new Error("has an index, but no end when read front to back");
  let crc = crc32Init();
  for await (const piece of pieces(readable, end - 13n)) crc = crc32Update(crc, piece);   // to the record that says where data ends
  const found = crc32Final(crc);
  if (wanted !== 0 && found !== wanted) throw new Error(`has data with the checksum ${found}, must be ${wanted}`);
}

async function read_with_index(readable, start, print) {
  const reader = await McapIndexedReader.Initialize({ readable });   // verifies the checksum of the summary
  await verify_data(readable, start);
  let count = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    print(channel, reader.schemasById.get(channel?.schemaId), message);
    ++count;
  }
  const wanted = reader.statistics?.messageCount;
  if (wanted !== undefined && wanted !== count) throw new Error(`has ${count} messages, must have ${wanted} by its statistics`);
}

const [name] = process.argv.slice(2);
if (name === undefined) {
  console.error("usage: node e2e/read_mcap.mjs FILE");
  process.exit(2);
}
try {
  const file = await open(name);
  const readable = await readable_of(file);
  const start = await summary_start(readable);
  if (start) {
    await read_with_index(readable, start, printer());
  } else {
    await read_without_index(readable, printer());
  }
  await file.close();
} catch (error) {
  console.error(`${name}: ${error instanceof Error ? error.message : error}`);
  process.exitCode = 1;
}
