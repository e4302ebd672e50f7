"""A simulated annotator: labels a shape through the editor, as a person would, and leaves a stroke log.

`Sight` is what a person sees, `motor` how long gestures take, `moves` what could be done next, `session` what is done.
"""
