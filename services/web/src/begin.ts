/**
 * The page's first script, and a small one: asks at once for what the address is going to need, while the code that shows
 * it is still on its way.
 */
import { collectionsQuery, meQuery, newQueryClient } from "./api/queries";
import { ROOM_ADDRESS } from "./app/roomAddress";
import { isRoom, ROOM_CODE } from "./app/roomCode";
import { applyScheme, savedScheme } from "./app/scheme/scheme";
import { takeOneTimeCode } from "./app/session/oneTimeCode";
import { HeadStart } from "./rooms/workbench/desk/headStart";
import { namedShapes } from "./rooms/workbench/namedShapes";
import "./styles/tokens.css";
import "./styles/base.css";

const code = takeOneTimeCode(window);
const page = import("./page");
applyScheme(savedScheme(localStorage), document.documentElement);
const queries = newQueryClient();
const { room, collectionId } = ROOM_ADDRESS.exec(location.pathname)?.groups ?? {};
if (isRoom(room)) ROOM_CODE[room]().catch(() => {}); // entering the room loads it again, and says what is wrong
let headStart: HeadStart | null = null;
if (code === null) {
  if (room === "work") headStart = new HeadStart(Number(collectionId), namedShapes(location.search));
  void queries.prefetchQuery(meQuery);
  void queries.prefetchQuery(collectionsQuery);
}
page.then(({ showPage }) => showPage(queries, code, headStart), sayThatNothingCame);

/** Else the window stays empty: where the network went, or the service has another version by now. */
function sayThatNothingCame(): void {
  document.body.textContent = "The page could not be loaded. Check the connection, then load it again.";
}
