/** How the service's list differs from the one that is shown, until somebody asks for it. */
import { count } from "../../../components/numbers";

/** nMore : shapes that the list has more, negative where it has fewer; 0 where they only have other places. */
export interface ListChange {
  readonly nMore: number;
}

export function changeWords({ nMore }: ListChange): string {
  if (nMore > 0) return count(nMore, "new shape");
  return nMore < 0 ? `${count(-nMore, "shape")} left the list` : "The order has changed";
}
