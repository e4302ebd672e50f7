"""The ecosystem's label formats, in and out, and the manifest that says what an export is."""
