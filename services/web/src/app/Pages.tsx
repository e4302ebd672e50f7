import { useQuery } from "@tanstack/react-query";
import { Redirect, Route, Switch } from "wouter";
import { collectionsQuery } from "../api/queries";
import { Button, Notice } from "../components";
import { CollectionPicker } from "./CollectionPicker";
import { RoomPage } from "./RoomPage";
import { ROOM_ADDRESS, roomAddress } from "./roomAddress";
import { ROOMS } from "./rooms";
import { Opening } from "./shell/Opening";
import { Shell } from "./shell/Shell";

/** What each address shows. Addresses outlive the page: people send them to each other. */
export function Pages() {
  const collections = useQuery(collectionsQuery);
  if (collections.data === undefined) {
    return (
      <Shell collection={null} room={null}>
        {collections.error ? (
          <Notice
            kind="error"
            isCentred
            title="The collections could not be read"
            actions={<Button onClick={() => void collections.refetch()}>Try again</Button>}
          >
            {collections.error.message}
          </Notice>
        ) : (
          <Opening />
        )}
      </Shell>
    );
  }
  const { items } = collections.data;
  const only = items.length === 1 ? items[0] : undefined;
  return (
    <Switch>
      <Route path="/">
        {only ? (
          <Redirect to={roomAddress(only.id, ROOMS[0].path)} replace />
        ) : (
          <CollectionPicker collections={items} />
        )}
      </Route>
      <Route path={ROOM_ADDRESS}>
        {({ collectionId, room }) => (
          <RoomPage
            collection={items.find((each) => String(each.id) === collectionId) ?? null}
            path={room ?? null}
          />
        )}
      </Route>
      <Route>
        <RoomPage collection={null} path={null} />
      </Route>
    </Switch>
  );
}
