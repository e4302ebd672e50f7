/** The rooms' code, which is loaded when they are entered. */

/** By the room's place in addresses: /c/3/table. */
export const ROOM_CODE = {
  table: async () => ({ default: (await import("../rooms/table/TableRoom")).TableRoom }),
  work: async () => ({ default: (await import("../rooms/workbench/WorkbenchRoom")).WorkbenchRoom }),
  operations: async () => ({ default: (await import("../rooms/operations/OperationsRoom")).OperationsRoom }),
  settings: async () => ({ default: (await import("../rooms/settings/SettingsRoom")).SettingsRoom }),
} as const;

export function isRoom(path: string | undefined): path is keyof typeof ROOM_CODE {
  return path !== undefined && Object.hasOwn(ROOM_CODE, path);
}
