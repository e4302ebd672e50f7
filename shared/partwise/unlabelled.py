"""What stands for "unlabelled": two numbers, because part ids are unsigned and start at 1, and classes start at 0."""

NO_PART_ID = 0
"""In arrays of part ids: label revisions, blocks."""

NO_CLASS = -1
"""In arrays of indices, such as a network's classes, and in label files."""
