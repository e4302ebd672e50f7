import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

const SERVICE = process.env.PARTWISE_SERVICE ?? "http://127.0.0.1:8000";

export default defineConfig({
  plugins: [react()],
  // While developing, the API is a running `partwise serve`; its cookie needs the page to be of its own origin.
  server: { proxy: { "/api": { target: SERVICE, headers: { origin: SERVICE } } } },
  build: {
    outDir: "../partwise_service/static",
    emptyOutDir: true,
    target: "es2023",
    assetsInlineLimit: 0, // the page's policy allows no data: addresses for scripts and styles
  },
  test: { environment: "node", include: ["src/**/*.test.{ts,tsx}"] },
});
