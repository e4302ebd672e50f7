/** Where an export is fetched from: the browser streams it to disk, as it may be larger than memory. */
export function downloadAddress(jobId: number): string {
  return `/api/v1/jobs/${jobId}/download`;
}
