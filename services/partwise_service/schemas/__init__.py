"""What travels as JSON, a file for each resource: requests are strict, answers say what every field means."""
