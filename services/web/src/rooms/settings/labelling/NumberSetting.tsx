import { useState } from "react";
import { Input } from "../../../components";

export interface NumberSettingProps {
  label: string;
  hint: string;
  value: number;
  min: number;
  max: number;
  unit?: string;
  isDisabled?: boolean;
  onChange: (value: number) => void;
}

/** A whole number in a range. While it is no such number, what was typed stays and nothing is set. */
export function NumberSetting({
  label,
  hint,
  value,
  min,
  max,
  unit,
  isDisabled = false,
  onChange,
}: NumberSettingProps) {
  const [typed, setTyped] = useState({ text: String(value), value });
  const text = typed.value === value ? typed.text : String(value); // the value was changed from elsewhere
  const refusal = isWholeIn(text, min, max)
    ? ""
    : `A whole number from ${min.toLocaleString("en")} to ${max.toLocaleString("en")}.`;
  return (
    <Input
      label={label}
      hint={hint}
      type="text"
      inputMode="numeric"
      value={text}
      disabled={isDisabled}
      error={refusal}
      // The browser does not send the form before it is right.
      ref={(input) => input?.setCustomValidity(refusal)}
      {...(unit !== undefined && { unit })}
      onChange={(event) => {
        const next = event.target.value;
        const isNextGood = isWholeIn(next, min, max);
        setTyped({ text: next, value: isNextGood ? Number(next) : value });
        if (isNextGood) onChange(Number(next));
      }}
    />
  );
}

export function isWholeIn(text: string, min: number, max: number): boolean {
  return /^\d+$/.test(text.trim()) && Number(text) >= min && Number(text) <= max;
}
