/** The settings' sections, each with an address of its own, and who may see them. */
import type { ComponentType } from "react";
import type { RoomProps } from "../../app/roomAddress";
import { hasRole, type Me, type Role } from "../../app/session/session";
import { AuditSection } from "./audit/AuditSection";
import { ExportSection } from "./export/ExportSection";
import { FilesSection } from "./files/FilesSection";
import { LabellingSection } from "./labelling/LabellingSection";
import { PeopleSection } from "./people/PeopleSection";

export interface Section {
  path: string;
  name: string;
  role: Role;
  /** It is about everything, so a token for some collections does not open it. */
  isForAllCollections: boolean;
  View: ComponentType<RoomProps>;
}

export const SECTIONS: readonly [Section, ...Section[]] = [
  {
    path: "labelling",
    name: "Labelling",
    role: "operator",
    isForAllCollections: false,
    View: LabellingSection,
  },
  { path: "files", name: "Add files", role: "operator", isForAllCollections: false, View: FilesSection },
  { path: "export", name: "Export", role: "operator", isForAllCollections: false, View: ExportSection },
  {
    path: "people",
    name: "People and tokens",
    role: "operator",
    isForAllCollections: false,
    View: PeopleSection,
  },
  { path: "audit", name: "Audit trail", role: "admin", isForAllCollections: true, View: AuditSection },
];

export function sectionsFor(me: Me): readonly Section[] {
  return SECTIONS.filter(
    ({ role, isForAllCollections }) => hasRole(me, role) && (!isForAllCollections || me.scope === null),
  );
}
