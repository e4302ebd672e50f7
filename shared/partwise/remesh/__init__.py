"""From polygon soup to a clean mesh that can be described, and back."""
