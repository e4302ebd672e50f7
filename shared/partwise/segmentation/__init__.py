"""What is done to labels over faces: patches, paint, and graph cuts on given labels or on a model's answer."""
