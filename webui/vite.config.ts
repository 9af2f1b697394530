import { defineConfig } from "vitest/config";

// Where `npm run dev` finds the requests and channels: `npm run mock`, or TASSILO_SERVER, the address that `tassilo serve` prints.
const address = new URL(process.env["TASSILO_SERVER"] ?? "http://127.0.0.1:8081");
const token = address.searchParams.get("token");
const proxy = {
  target: address.origin,
  changeOrigin: true,
  ws: true,
  // The server refuses requests from pages that are not its own, which those of the development server are not.
  headers: { origin: address.origin, ...(token === null ? {} : { authorization: `Bearer ${token}` }) },
};

export default defineConfig({
  base: "./",
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: {
    target: "es2022",
    // Everything is a file of its own: data: addresses and inline scripts are refused by the server's content policy.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    reportCompressedSize: false,
    rollupOptions: { input: ["index.html", "monitor.html"] },   // of `tassilo serve`, of `tassilo monitor`
  },
  server: {
    host: "127.0.0.1",
    proxy: { "/api": proxy, "/ws/": proxy },
  },
  test: { include: ["src/**/*.test.ts"], environment: "node" },
});
