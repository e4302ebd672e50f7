import { Suspense } from "react";
import { Link, Redirect } from "wouter";
import { Notice } from "../components";
import { type Collection, CollectionContext } from "./CollectionContext";
import { ErrorBoundary } from "./errors/ErrorBoundary";
import { RoomHeading } from "./RoomHeading";
import { roomAddress } from "./roomAddress";
import { ROOMS, type Room } from "./rooms";
import { useMe } from "./session/MeContext";
import { hasRole, ROLE_WORDS } from "./session/session";
import { Opening } from "./shell/Opening";
import { Shell } from "./shell/Shell";

/** One room of one collection, or why it cannot be shown. `path` : of the room; null leads to the first. */
export function RoomPage({ collection, path }: { collection: Collection | null; path: string | null }) {
  const room = ROOMS.find((each) => each.path === path);
  if (collection === null) return <NoSuchPage />;
  if (path === null) return <Redirect to={roomAddress(collection.id, ROOMS[0].path)} replace />;
  if (room === undefined) return <NoSuchPage />;
  return (
    <CollectionContext value={collection}>
      <Shell collection={collection} room={room.path}>
        <ErrorBoundary resetKey={`${collection.id}/${room.path}`}>
          <Entered key={`${collection.id}/${room.path}`} collection={collection} room={room} />
        </ErrorBoundary>
      </Shell>
    </CollectionContext>
  );
}

function Entered({ collection, room }: { collection: Collection; room: Room }) {
  const me = useMe();
  const { View } = room;
  if (!hasRole(me, room.role)) return <Closed room={room} collectionId={collection.id} />;
  return (
    <Suspense fallback={<Opening />}>
      <View collectionId={collection.id} />
    </Suspense>
  );
}

function Closed({ room, collectionId }: { room: Room; collectionId: number }) {
  const me = useMe();
  return (
    <>
      <RoomHeading title={room.name} isUnseen />
      <Notice
        kind="empty"
        title={`${room.name} is not open to you`}
        actions={<Link href={roomAddress(collectionId, ROOMS[0].path)}>Go to the table</Link>}
      >
        It {room.purpose}, for people with the role {ROLE_WORDS[room.role].toLowerCase()} or above. Yours is{" "}
        {ROLE_WORDS[me.role].toLowerCase()}. If you need it, ask whoever gave you your token.
      </Notice>
    </>
  );
}

function NoSuchPage() {
  return (
    <Shell collection={null} room={null}>
      <h1 className="unseen">Nothing here</h1>
      <Notice
        kind="empty"
        title="There is nothing at this address"
        actions={<Link href="/">Go to your collections</Link>}
      >
        The collection may have been removed, or your token does not open it. Check the address, or ask
        whoever sent it.
      </Notice>
    </Shell>
  );
}
