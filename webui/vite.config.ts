import { defineConfig } from "vitest/config";

// Where `npm run dev` finds the requests and channels: `npm run mock`, or `tassilo serve` with TASSILO_SERVER set.
const server = process.env["TASSILO_SERVER"] ?? "http://127.0.0.1:8081";

export default defineConfig({
  base: "./",
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: {
    target: "es2022",
    // Everything is a file of its own: data: addresses and inline scripts are refused by the server's content policy.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
  },
  server: {
    host: "127.0.0.1",
    proxy: {
      "/api": { target: server, changeOrigin: true },
      "/ws": { target: server, changeOrigin: true, ws: true },
    },
  },
  test: { include: ["src/**/*.test.ts"], environment: "node" },
});
