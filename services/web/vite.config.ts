import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

const SERVICE = process.env.PARTWISE_SERVICE ?? "http://127.0.0.1:8000";

export default defineConfig({
  plugins: [react()],
  // While developing, the API is a running `partwise serve`; its cookie needs the page to be of its own origin.
  server: { proxy: { "/api": { target: SERVICE, headers: { origin: SERVICE } } } },
  worker: { format: "es" }, // in parts: what a worker needs later is loaded later
  build: {
    outDir: "../partwise_service/static",
    emptyOutDir: true,
    target: "es2023",
    assetsInlineLimit: 0, // the page's policy allows no data: addresses for scripts and styles
    rolldownOptions: {
      output: {
        // Browsers ask for six files at a time: what the first script needs is one, and what rooms share is another.
        codeSplitting: {
          groups: [
            { name: "first", tags: ["$initial"], priority: 1 },
            { name: "shared", minShareCount: 2 },
          ],
        },
      },
    },
  },
  test: { environment: "node", include: ["src/**/*.test.{ts,tsx}"] },
});
