import { type QueryClient, QueryClientProvider } from "@tanstack/react-query";
import { ToastProvider } from "../components";
import { ErrorBoundary } from "./errors/ErrorBoundary";
import { ServiceEventsProvider } from "./events/ServiceEventsProvider";
import { NavigationCounter } from "./NavigationCounter";
import { Pages } from "./Pages";
import { SessionGate } from "./session/SessionGate";

/** The page. `code` : a one-time login that came with the address. */
export function App({ queries, code }: { queries: QueryClient; code: string | null }) {
  return (
    <QueryClientProvider client={queries}>
      <ToastProvider>
        <ErrorBoundary resetKey="">
          <SessionGate code={code}>
            <ServiceEventsProvider>
              <NavigationCounter>
                <Pages />
              </NavigationCounter>
            </ServiceEventsProvider>
          </SessionGate>
        </ErrorBoundary>
      </ToastProvider>
    </QueryClientProvider>
  );
}
