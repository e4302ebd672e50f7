/** Shapes that the workbench shows side by side. */
export const MAX_OPEN = 4;
