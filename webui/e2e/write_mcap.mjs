// Writes a log with @mcap/core: what others write is what our reader reads.
//
// usage: node e2e/write_mcap.mjs KIND COUNT FILE
// KIND: chunks, with an index; no_index, chunks without one; no_chunks, messages on their own; small, of the summary nothing but the statistics; lz4, a chunk that says it is compressed
// Message i of COUNT is on /even or /odd, numbered from 0 in each, with i % 50 bytes of value i, in chunks that overlap in time.
import { open } from "node:fs/promises";
import { McapWriter } from "@mcap/core";

const kinds = {
  chunks: {},
  no_index: { useChunkIndex: false, useMessageIndex: false, useStatistics: false, useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false,
    useAttachmentIndex: false, useMetadataIndex: false },
  no_chunks: { useChunks: false },
  small: { useSummaryOffsets: false, repeatSchemas: false, repeatChannels: false, useMessageIndex: false, useChunkIndex: false },
  lz4: { compressChunk: (data) => ({ compression: "lz4", compressedData: data }) },
};

const [kind, count, name] = process.argv.slice(2);
if (!(kind in kinds) || name === undefined) {
  console.error(`usage: node e2e/write_mcap.mjs ${Object.keys(kinds).join("|")} COUNT FILE`);
  process.exit(2);
}
const file = await open(name, "w");
let size = 0n;
const writable = {
  position: () => size,
  write: async (bytes) => {
    await file.write(bytes);
    size += BigInt(bytes.length);
  },
};
const writer = new McapWriter({ writable, chunkSize: 500, startChannelId: 0, ...kinds[kind] });
await writer.start({ profile: "", library: "test" });
const encode = (text) => new TextEncoder().encode(text);
const even = await writer.registerSchema({ name: "a/msg/Even", encoding: "ros2msg", data: encode("bool even") });
const odd = await writer.registerSchema({ name: "a/msg/Odd", encoding: "jsonschema", data: encode("{}") });
const channels = [
  await writer.registerChannel({ topic: "/even", schemaId: even, messageEncoding: "cdr", metadata: new Map([["k", "v"]]) }),
  await writer.registerChannel({ topic: "/odd", schemaId: odd, messageEncoding: "json", metadata: new Map() }),
];
const begin = 1764288000n * 1000000000n;
for (let i = 0; i < Number(count); ++i) {
  const logTime = begin + BigInt(1000 * i - (i % 7) * 20000);
  await writer.addMessage({ channelId: channels[i % 2], sequence: i >> 1, logTime, publishTime: logTime - 1n, data: new Uint8Array(i % 50).fill(i % 256) });
  if (i === 20) {
    await writer.addAttachment({ name: "a", logTime, createTime: logTime, mediaType: "text/plain", data: encode("attached") });
    await writer.addMetadata({ name: "robot", metadata: new Map([["id", "3"]]) });
  }
}
await writer.end();
await file.close();
